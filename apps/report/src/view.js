import * as THREE from 'three';
import {OrbitControls} from 'three/examples/jsm/controls/OrbitControls.js';
import {toCreasedNormals} from 'three/examples/jsm/utils/BufferGeometryUtils.js';

import * as palette from './palette.js';
import {indexAt} from './run_data.js';

/** From where the camera looks, in the world's axes (z up). */
export const cameras = {
  overview: [1, -1.1, 0.75],
  front: [1, 0, 0.12],
  side: [0, -1, 0.12],
  top: [0, -0.001, 1],
  hand: [0.8, -1, 0.55],
};

const colour = {plain: 0xe9e7e1, skin: 0x66859a, touching: 0xff7a1a, force: 0xd6281e, mark: 0xc2187f, truth: 0x222222,
  found: 0x0a8f5a};
const glowForce = 1; // N, from which on a link that touches is fully coloured
const arrowLength = 0.07; // m, of the force that nine of ten contacts stay below

function setPose(object, numbers, at = 0) {
  object.position.set(numbers[at], numbers[at + 1], numbers[at + 2]);
  object.quaternion.set(numbers[at + 4], numbers[at + 5], numbers[at + 6], numbers[at + 3]);
}

function capsuleMesh({from, to, radius}, material) {
  const start = new THREE.Vector3(...from);
  const along = new THREE.Vector3(...to).sub(start);
  const length = along.length();
  const geometry = length > 1e-9 ? new THREE.CapsuleGeometry(radius, length, 10, 28)
    : new THREE.SphereGeometry(radius, 28, 18);
  const mesh = new THREE.Mesh(geometry, material);
  mesh.position.copy(start).addScaledVector(along, 0.5);
  if (length > 1e-9) mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), along.normalize());
  return mesh;
}

function surfaceGeometry({vertices, triangles}) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(vertices, 3));
  geometry.setIndex(triangles);
  return toCreasedNormals(geometry, 0.6);
}

/** An arrow of unit length along +y whose tip is at the origin. */
function makeArrow(material) {
  const arrow = new THREE.Group();
  const shaft = new THREE.Mesh(new THREE.CylinderGeometry(1, 1, 1, 12), material);
  const head = new THREE.Mesh(new THREE.ConeGeometry(1, 1, 20), material);
  arrow.add(shaft, head);
  arrow.setLength = (length) => {
    const headLength = Math.min(0.018, 0.5 * length);
    head.scale.set(0.4 * headLength, headLength, 0.4 * headLength);
    head.position.y = -headLength / 2;
    const shaftLength = Math.max(1e-6, length - headLength);
    shaft.scale.set(0.0022, shaftLength, 0.0022);
    shaft.position.y = -headLength - shaftLength / 2;
  };
  for (const part of [shaft, head]) part.renderOrder = 10;
  return arrow;
}

function roundSprite() {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = 64;
  const context = canvas.getContext('2d');
  context.arc(32, 32, 30, 0, 2 * Math.PI);
  context.fillStyle = 'white';
  context.fill();
  return new THREE.CanvasTexture(canvas);
}

/** Robot, objects, forces, touched points and references of a run, at the time it is told. */
export class View {
  /** `forceScale`: m of arrow for each N; the same for all runs on a page. */
  constructor(host, run, forceScale) {
    this.host = host;
    this.run = run;
    this.forceScale = forceScale;
    this.time = 0;
    this.shown = {forces: true, points: true, references: true};
    this.renderer = new THREE.WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.world = new THREE.Scene();
    this.world.background = new THREE.Color(0xf3f5f7);
    this.camera = new THREE.PerspectiveCamera(32, 1, 0.01, 60);
    this.camera.up.set(0, 0, 1);
    this.labels = document.createElement('div');
    this.labels.className = 'labels';
    host.append(this.renderer.domElement, this.labels);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.links = new Map();
    this.objects = new Map();
    this.arrows = [];
    this.marks = [];
    this.#build();
    this.setCamera('overview');
    this.controls.addEventListener('change', () => this.draw());
    new ResizeObserver(() => this.#resize()).observe(host);
    this.#resize();
  }

  #build() {
    this.robot = new THREE.Group();
    this.things = new THREE.Group();
    this.world.add(this.robot, this.things);
    for (const link of this.run.scene.links) this.#addLink(link);
    this.run.scene.objects.forEach((object, i) => this.#addObject(object, palette.objects[i % palette.objects.length]));
    this.#addTouched();
    this.#addMarks();
    this.arrowMaterial = new THREE.MeshBasicMaterial({color: colour.force, depthTest: false, transparent: true,
      opacity: 0.92});
    this.world.updateMatrixWorld(true);
    this.#measure();
    this.#addGround();
    this.#addLights();
  }

  #addLink(link) {
    const material = new THREE.MeshStandardMaterial({color: link.skin ? colour.skin : colour.plain, roughness: 0.55,
      metalness: 0.05});
    const group = new THREE.Group();
    for (const capsule of link.capsules) group.add(capsuleMesh(capsule, material));
    for (const box of link.boxes) {
      const mesh = new THREE.Mesh(new THREE.BoxGeometry(...box.size), material);
      setPose(mesh, box.pose);
      group.add(mesh);
    }
    for (const mesh of group.children) mesh.castShadow = mesh.receiveShadow = true;
    setPose(group, link.pose);
    this.robot.add(group);
    this.links.set(link.name, {group, material, rest: material.color.clone(), column: this.run.column('link/' + link.name)});
  }

  #addObject(object, shade) {
    const geometry = surfaceGeometry(object);
    const material = new THREE.MeshStandardMaterial({color: shade, roughness: 0.8, polygonOffset: true,
      polygonOffsetFactor: 1, polygonOffsetUnits: 1});
    const mesh = new THREE.Mesh(geometry, material);
    mesh.castShadow = mesh.receiveShadow = true;
    const edges = new THREE.LineSegments(new THREE.EdgesGeometry(geometry, 35),
      new THREE.LineBasicMaterial({color: 0x000000, transparent: true, opacity: 0.35}));
    const group = new THREE.Group();
    group.add(mesh, edges);
    setPose(group, object.pose);
    this.things.add(group);
    this.objects.set(object.name, {group, rest: object.pose, column: this.run.column('object/' + object.name)});
  }

  /** Points on an object that moves go with it; all others stay where they were. */
  #addTouched() {
    const {touched} = this.run;
    const material = new THREE.PointsMaterial({size: 4 * window.devicePixelRatio, sizeAttenuation: false,
      vertexColors: true, map: roundSprite(), alphaTest: 0.5});
    const clouds = new Map([['', {host: this.world, times: [], positions: [], colours: []}]]);
    for (const [name, part] of this.objects) {
      if (part.column >= 0) clouds.set(name, {host: part.group, part, times: [], positions: [], colours: []});
    }
    this.run.touchedOn().forEach((on, i) => {
      const [time, x, y, z, height] = touched.subarray(5 * i, 5 * i + 5);
      const {part, times, positions, colours} = clouds.get(on) ?? clouds.get('');
      const point = new THREE.Vector3(x, y, z);
      if (part) {
        this.#moveTo(part, time);
        point.sub(part.group.position).applyQuaternion(part.group.quaternion.clone().invert());
      }
      times.push(time);
      positions.push(...point.toArray());
      colours.push(...new THREE.Color().setRGB(...palette.viridisAt(height), THREE.SRGBColorSpace).toArray());
    });
    this.clouds = [...clouds.values()].map(({host, times, positions, colours}) => {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
      geometry.setAttribute('color', new THREE.Float32BufferAttribute(colours, 3));
      const points = new THREE.Points(geometry, material);
      points.frustumCulled = false;
      host.add(points);
      return {points, times};
    });
    this.touched = this.clouds[0].points;
    for (const part of this.objects.values()) if (part.column >= 0) setPose(part.group, part.rest);
  }

  /** Where something that moves is at a time, between two frames. */
  #moveTo({group, column}, time) {
    const {run} = this;
    const [frame, next, share] = run.frameAt(time);
    setPose(group, run.frames, frame * run.width + column);
    if (share === 0) return;
    const at = next * run.width + column;
    group.position.lerp(new THREE.Vector3(...run.frames.subarray(at, at + 3)), share);
    const [w, x, y, z] = run.frames.subarray(at + 3, at + 7);
    group.quaternion.slerp(new THREE.Quaternion(x, y, z, w), share);
  }

  /** What tasks steer for, and features where they are and where they were found. */
  #addMarks() {
    const ball = new THREE.SphereGeometry(0.008, 20, 14);
    const add = (name, shade, position, column, ring) => {
      const material = new THREE.MeshBasicMaterial({color: shade, depthTest: false, transparent: true, opacity: 0.85,
        wireframe: ring});
      const mesh = new THREE.Mesh(ball, material);
      mesh.renderOrder = 9;
      if (position) mesh.position.set(...position);
      const label = document.createElement('span');
      label.textContent = name;
      label.style.color = '#' + new THREE.Color(shade).getHexString();
      this.labels.append(label);
      this.world.add(mesh);
      this.marks.push({mesh, label, column});
    };
    this.run.columns.forEach((path, column) => {
      if (!path.startsWith('mark/') || !path.endsWith('/x')) return;
      const [, task, name] = path.split('/');
      add(task + ' ' + name, colour.mark, null, column, false);
    });
    for (const feature of this.run.features) {
      if (feature.truth) add(feature.name + ', true top', colour.truth, feature.truth, -1, true);
      if (feature.position) add(feature.name + ', found', colour.found, feature.position, -1, false);
    }
  }

  /** What the cameras aim at: the robot with all objects, and where the run touched. */
  #measure() {
    const whole = new THREE.Box3().setFromObject(this.robot);
    for (const {group} of this.objects.values()) {
      const box = new THREE.Box3().setFromObject(group);
      const size = box.getSize(new THREE.Vector3());
      if (Math.max(size.x, size.y, size.z) < 2.5) whole.union(box);
    }
    if (whole.isEmpty()) whole.set(new THREE.Vector3(-0.5, -0.5, 0), new THREE.Vector3(0.5, 0.5, 1));
    this.boxes = {whole, touched: this.#touchedBox(0, this.run.count)};
  }

  /** Around all touches of these frames; empty where there are none. */
  #touchedBox(from, to) {
    const box = new THREE.Box3();
    for (let row = this.run.firstContact[from]; row < this.run.firstContact[to]; ++row) {
      box.expandByPoint(new THREE.Vector3(...this.run.contacts.subarray(9 * row + 3, 9 * row + 6)));
    }
    return box.isEmpty() ? box : box.expandByScalar(0.05);
  }

  /** Where the hand touches about now, or where the run touched at all. */
  #handBox() {
    if (!this.run.count) return this.boxes.whole;
    const [frame] = this.run.frameAt(this.time);
    const now = this.#touchedBox(Math.max(0, frame - 5), Math.min(this.run.count, frame + 6));
    return [now, this.boxes.touched, this.boxes.whole].find((box) => !box.isEmpty());
  }

  #addGround() {
    const {whole} = this.boxes;
    const middle = whole.getCenter(new THREE.Vector3());
    const floor = Math.min(0, whole.min.z);
    const grid = new THREE.GridHelper(4, 40, 0xb8c0c8, 0xdde2e7);
    grid.rotation.x = Math.PI / 2;
    grid.position.set(Math.round(middle.x * 10) / 10, Math.round(middle.y * 10) / 10, floor - 0.001);
    const shade = new THREE.Mesh(new THREE.PlaneGeometry(6, 6), new THREE.ShadowMaterial({opacity: 0.14}));
    shade.position.set(middle.x, middle.y, floor - 0.002);
    shade.receiveShadow = true;
    this.world.add(grid, shade);
  }

  #addLights() {
    const middle = this.boxes.whole.getCenter(new THREE.Vector3());
    const reach = this.boxes.whole.getSize(new THREE.Vector3()).length() / 2;
    this.world.add(new THREE.HemisphereLight(0xffffff, 0xb9b2a6, 1.9));
    const sun = new THREE.DirectionalLight(0xffffff, 2);
    sun.position.copy(middle).add(new THREE.Vector3(0.6, -0.8, 1.8).multiplyScalar(reach));
    sun.target.position.copy(middle);
    sun.castShadow = true;
    sun.shadow.mapSize.set(2048, 2048);
    sun.shadow.bias = -0.0005;
    sun.shadow.normalBias = 0.004;
    Object.assign(sun.shadow.camera, {left: -reach, right: reach, top: reach, bottom: -reach, near: 0.01, far: 6 * reach});
    this.world.add(sun, sun.target);
  }

  setCamera(name) {
    const box = name === 'hand' ? this.#handBox() : this.boxes.whole;
    const target = box.getCenter(new THREE.Vector3());
    const radius = box.getSize(new THREE.Vector3()).length() / 2;
    const narrow = Math.min(1, this.camera.aspect);
    const distance = 0.72 * radius / Math.sin(THREE.MathUtils.degToRad(this.camera.fov / 2)) / narrow;
    this.cameraName = name;
    this.camera.position.copy(target).addScaledVector(new THREE.Vector3(...cameras[name]).normalize(), distance);
    this.controls.target.copy(target);
    this.controls.update();
  }

  /** Looks from where another view looks. */
  follow(other) {
    this.camera.position.copy(other.camera.position);
    this.controls.target.copy(other.controls.target);
    this.controls.update();
  }

  show(time) {
    const {run} = this;
    this.time = time;
    if (!run.count) return this.draw();
    const [frame] = run.frameAt(time);
    for (const part of [...this.links.values(), ...this.objects.values()]) {
      if (part.column >= 0) this.#moveTo(part, time);
    }
    this.#showContacts(run.contactsOf(frame));
    for (const {points, times} of this.clouds) {
      points.geometry.setDrawRange(0, this.shown.points && times[0] <= time ? indexAt(times, time) + 1 : 0);
    }
    for (const {mesh, column} of this.marks) {
      if (column >= 0) mesh.position.fromArray(run.frames, frame * run.width + column);
      mesh.visible = this.shown.references;
    }
    this.draw();
  }

  #showContacts(contacts) {
    const pressed = new Map();
    contacts.forEach((contact, i) => {
      if (i === this.arrows.length) {
        this.arrows.push(makeArrow(this.arrowMaterial));
        this.world.add(this.arrows[i]);
      }
      const arrow = this.arrows[i];
      const force = new THREE.Vector3(...contact.force);
      const size = force.length();
      arrow.visible = this.shown.forces && size > 1e-6;
      arrow.position.set(...contact.point);
      if (size > 1e-6) arrow.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), force.normalize());
      arrow.setLength(Math.min(0.3, Math.max(0.004, size * this.forceScale)));
      for (const name of [contact.link, contact.on]) pressed.set(name, (pressed.get(name) || 0) + size);
    });
    for (let i = contacts.length; i < this.arrows.length; ++i) this.arrows[i].visible = false;
    this.touching = 0;
    for (const [name, {material, rest}] of this.links) {
      const share = Math.min(1, (pressed.get(name) || 0) / glowForce);
      this.touching += share > 0;
      material.color.copy(rest).lerp(new THREE.Color(colour.touching), share > 0 ? 0.35 + 0.65 * share : 0);
    }
  }

  #resize() {
    const {clientWidth: width, clientHeight: height} = this.host;
    if (!width || !height) return;
    this.renderer.setSize(width, height);
    const before = this.camera.aspect;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (Math.abs(before - this.camera.aspect) > 1e-3) this.setCamera(this.cameraName);
    this.draw();
  }

  draw() {
    this.renderer.render(this.world, this.camera);
    const {clientWidth: width, clientHeight: height} = this.host;
    const places = this.marks.map(({mesh, label}) => {
      const at = mesh.position.clone().project(this.camera);
      label.hidden = !mesh.visible || at.z > 1;
      return {label, x: (at.x + 1) / 2 * width + 12, y: (1 - at.y) / 2 * height - 8};
    });
    // From the top down, each below those that it would cover.
    places.sort((a, b) => a.y - b.y);
    places.forEach((place, i) => {
      for (const above of places.slice(0, i)) {
        if (Math.abs(above.x - place.x) < 130 && place.y - above.y < 15) place.y = above.y + 15;
      }
      place.label.style.transform = `translate(${place.x.toFixed(1)}px, ${place.y.toFixed(1)}px)`;
    });
  }
}

export function forceScaleOf(runs) {
  return arrowLength / Math.max(1e-3, ...runs.map((run) => run.usualForce()));
}
