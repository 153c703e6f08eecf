import 'uplot/dist/uPlot.min.css';
import './style.css';

import {Clock} from './clock.js';
import {Plots} from './plots.js';
import {RunData} from './run_data.js';
import {View, cameras, forceScaleOf} from './view.js';

function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  Object.assign(made, properties);
  made.append(...children);
  return made;
}

/** Play, time, speed, cameras and what is shown. */
function addControls(host, clock, views) {
  const play = element('button', {type: 'button', className: 'play', title: 'Play or pause (space)'});
  const slider = element('input', {type: 'range', className: 'time', min: clock.start, max: clock.end, step: 'any',
    title: 'Time (arrow keys: a frame)'});
  const reading = element('output');
  const speed = element('select', {title: 'Speed'});
  for (const factor of [0.1, 0.25, 0.5, 1, 2, 4]) {
    speed.append(element('option', {value: factor, textContent: factor + ' ×', selected: factor === 1}));
  }
  play.addEventListener('click', () => clock.toggle());
  slider.addEventListener('input', () => clock.seek(Number(slider.value)));
  speed.addEventListener('change', () => clock.setSpeed(Number(speed.value)));
  const transport = element('div', {className: 'transport'}, play, slider, reading, speed);

  const presets = element('div', {className: 'presets'});
  const choose = (name) => {
    for (const view of views) view.setCamera(name);
  };
  for (const name of Object.keys(cameras)) {
    const button = element('button', {type: 'button', textContent: name});
    button.addEventListener('click', () => choose(name));
    presets.append(button);
  }
  for (const name of ['forces', 'points', 'references']) {
    const box = element('input', {type: 'checkbox', checked: true});
    box.addEventListener('change', () => {
      for (const view of views) {
        view.shown[name] = box.checked;
        view.show(clock.time);
      }
    });
    presets.append(element('label', {}, box, name));
  }
  host.append(transport, presets);
  document.addEventListener('keydown', (event) => {
    if (event.target.closest('input, select, button')) return;
    if (event.key === ' ') clock.toggle();
    else if (event.key === 'ArrowRight') clock.seek(clock.time + 0.02);
    else if (event.key === 'ArrowLeft') clock.seek(clock.time - 0.02);
    else return;
    event.preventDefault();
  });
  clock.listen(() => {
    slider.value = clock.time;
    reading.textContent = clock.time.toFixed(2) + ' s';
    play.textContent = clock.playing ? '❚❚' : '▶';
    play.setAttribute('aria-label', clock.playing ? 'pause' : 'play');
  });
}

function legend(runs, forceScale) {
  const key = element('p', {className: 'legend'});
  const add = (shade, words) => key.append(element('span', {style: 'background:' + shade}), words);
  add('#66859a', 'skin');
  add('#ff7a1a', 'skin that touches');
  add('#d6281e', `force of the robot: ${(0.01 / forceScale).toPrecision(2)} N for each cm of arrow`);
  if (runs.some((run) => run.touched.length)) {
    key.append(element('span', {className: 'ramp'}), 'touched points, by height: low to high');
  }
  if (runs.some((run) => run.columns.some((path) => path.startsWith('mark/')))) add('#c2187f', 'what tasks steer for');
  return key;
}

/** A view, or why there is none. */
function makeView(host, run, forceScale) {
  if (!run.scene) {
    host.append(element('p', {className: 'missing', textContent: 'No replay was recorded of this run.'}));
    return null;
  }
  try {
    return new View(host, run, forceScale);
  } catch (error) {
    host.append(element('p', {className: 'missing', textContent: 'No replay: ' + error.message}));
    return null;
  }
}

function build(host, runs) {
  const spans = runs.map((run) => run.span()).filter(Boolean);
  const clock = new Clock(Math.min(0, ...spans.map(([start]) => start)), Math.max(0, ...spans.map(([, end]) => end)));
  const forceScale = forceScaleOf(runs);
  host.classList.toggle('beside', runs.length > 1);
  const stage = element('div', {className: 'stage'});
  const pictures = element('div', {className: 'pictures'});
  const charts = element('div', {className: 'charts'});
  stage.append(pictures);
  host.append(stage, charts);

  const hosts = runs.map((run) => {
    const picture = element('div', {className: 'picture'});
    const column = element('div', {className: 'column'});
    if (runs.length > 1) picture.append(element('h2', {textContent: run.title}));
    pictures.append(picture);
    charts.append(column);
    return {picture, column};
  });
  const views = runs.map((run, i) => makeView(hosts[i].picture, run, forceScale)).filter(Boolean);
  addControls(stage, clock, views);
  stage.append(legend(runs, forceScale));
  for (const note of runs.flatMap((run) => run.notes.map((words) => (runs.length > 1 ? run.title + ': ' : '') + words))) {
    stage.append(element('p', {className: 'note', textContent: note}));
  }
  const plots = runs.map((run, i) => new Plots(hosts[i].column, run, clock, runs.map((one) => one.plots)));
  for (const view of views) {
    clock.listen(() => view.show(clock.time));
    view.controls.addEventListener('change', () => {
      if (views.leader && views.leader !== view) return;
      views.leader = view;
      for (const other of views) if (other !== view) other.follow(view);
      views.leader = null;
    });
  }
  return {clock, views, plots};
}

/** "#figure=scene&at=12.5&camera=hand": one picture alone, for printing. */
function applyAddress({clock, views}) {
  const wanted = new URLSearchParams(location.hash.slice(1));
  if (wanted.has('figure')) document.body.dataset.figure = wanted.get('figure');
  window.dispatchEvent(new Event('resize'));
  const at = Number(wanted.get('at'));
  clock.seek(wanted.has('at') && Number.isFinite(at) ? at : clock.start);
  if (wanted.has('camera') && wanted.get('camera') in cameras) {
    for (const view of views) view.setCamera(wanted.get('camera'));
  }
}

const host = document.querySelector('#replay');
const runs = RunData.fromPage();
if (host && runs.length) {
  window.tactus = build(host, runs); // for scripts that steer the page
  applyAddress(window.tactus);
}
