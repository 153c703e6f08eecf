// The report as a reader has it: real runs by the real program, their pages opened from disk in headless Chromium, which
// is steered through its debugging pipe.  Exit code 77, which CTest counts as skipped, where there is no Chromium.
//
//   node report_page.mjs TACTUS SOURCE_FOLDER

import assert from 'node:assert/strict';
import {execFileSync, spawn} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync, statSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {pathToFileURL} from 'node:url';
import {inflateSync} from 'node:zlib';

const [tactus, source] = process.argv.slice(-2);

function findBrowser() {
  for (const name of ['chromium', 'chromium-browser', 'google-chrome']) {
    try {
      return execFileSync('which', [name], {stdio: ['ignore', 'pipe', 'ignore']}).toString().trim();
    } catch {
      // the next
    }
  }
  console.log('skipped: no Chromium on the path; scripts/install_dependencies installs it');
  process.exit(77);
}

/** Chromium without a window; `send` asks it something, `seen` holds the events of pages. */
class Browser {
  constructor(path, profile) {
    const flags = ['--headless', '--remote-debugging-pipe', '--window-size=1500,1100', '--use-angle=swiftshader',
      '--enable-unsafe-swiftshader', '--user-data-dir=' + profile, '--no-first-run', '--disable-background-networking',
      '--disable-component-update', '--disable-sync', ...(process.getuid() === 0 ? ['--no-sandbox'] : [])];
    this.process = spawn(path, flags, {stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe']});
    this.waiting = new Map();
    this.listeners = [];
    this.count = 0;
    let rest = '';
    this.process.stdio[4].setEncoding('utf8').on('data', (part) => {
      const messages = (rest + part).split('\0');
      rest = messages.pop();
      for (const text of messages) this.#take(JSON.parse(text));
    });
  }

  #take(message) {
    if (!message.id) {
      for (const listener of this.listeners) listener(message);
      return;
    }
    const {resolve, reject} = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    if (message.error) reject(new Error(message.error.message));
    else resolve(message.result);
  }

  send(method, params = {}, sessionId = undefined) {
    const id = ++this.count;
    this.process.stdio[3].write(JSON.stringify({id, method, params, sessionId}) + '\0');
    return new Promise((resolve, reject) => this.waiting.set(id, {resolve, reject}));
  }

  async open(url) {
    const {targetId} = await this.send('Target.createTarget', {url: 'about:blank'});
    const {sessionId} = await this.send('Target.attachToTarget', {targetId, flatten: true});
    const page = new Page(this, sessionId);
    for (const domain of ['Page', 'Runtime', 'Log', 'Network']) await page.send(domain + '.enable');
    const loaded = page.next('Page.loadEventFired');
    await page.send('Page.navigate', {url});
    await loaded;
    return page;
  }

  async close() {
    const ended = new Promise((resolve) => this.process.on('exit', resolve));
    this.send('Browser.close').catch(() => {});
    await ended;
  }
}

class Page {
  constructor(browser, session) {
    this.browser = browser;
    this.session = session;
    this.complaints = [];
    this.requests = [];
    browser.listeners.push(({method, params, sessionId}) => {
      if (sessionId !== session) return;
      if (method === 'Runtime.exceptionThrown') this.complaints.push(params.exceptionDetails.exception?.description);
      if (method === 'Runtime.consoleAPICalled' && params.type === 'error') {
        this.complaints.push(params.args.map((one) => one.value ?? one.description).join(' '));
      }
      if (method === 'Log.entryAdded' && params.entry.level === 'error') this.complaints.push(params.entry.text);
      if (method === 'Network.requestWillBeSent') this.requests.push(params.request.url);
    });
  }

  send(method, params) {
    return this.browser.send(method, params, this.session);
  }

  next(method) {
    return new Promise((resolve) => this.browser.listeners.push((event) => {
      if (event.method === method && event.sessionId === this.session) resolve(event.params);
    }));
  }

  async evaluate(expression) {
    const {result, exceptionDetails} = await this.send('Runtime.evaluate', {expression, returnByValue: true,
      awaitPromise: true});
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  /** A real click in the middle of an element. */
  async click(selector) {
    const [x, y] = await this.evaluate(`(() => { const box = document.querySelector(${JSON.stringify(selector)})
      .getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; })()`);
    for (const type of ['mousePressed', 'mouseReleased']) {
      await this.send('Input.dispatchMouseEvent', {type, x, y, button: 'left', buttons: 1, clickCount: 1});
    }
  }

  /** What of the page an element covers, as {width, height, pixels (RGB)}. */
  async picture(selector) {
    const clip = await this.evaluate(`(() => { const box = document.querySelector(${JSON.stringify(selector)})
      .getBoundingClientRect(); return {x: box.x, y: box.y, width: box.width, height: box.height, scale: 1}; })()`);
    const {data} = await this.send('Page.captureScreenshot', {format: 'png', clip});
    return decodePng(Buffer.from(data, 'base64'));
  }
}

/** PNG of 8 bits a channel, RGB or RGBA, not interlaced: what Chromium writes. */
function decodePng(file) {
  const parts = [];
  let width, height, channels;
  for (let at = 8; at < file.length;) {
    const length = file.readUInt32BE(at);
    const type = file.toString('latin1', at + 4, at + 8);
    const body = file.subarray(at + 8, at + 8 + length);
    if (type === 'IHDR') {
      [width, height] = [body.readUInt32BE(0), body.readUInt32BE(4)];
      assert.equal(body[8], 8);
      channels = {2: 3, 6: 4}[body[9]];
    }
    if (type === 'IDAT') parts.push(body);
    at += 12 + length;
  }
  const raw = inflateSync(Buffer.concat(parts));
  const stride = width * channels;
  const bytes = Buffer.alloc(stride * height);
  for (let y = 0; y < height; ++y) {
    const filter = raw[y * (stride + 1)];
    for (let x = 0; x < stride; ++x) {
      const left = x >= channels ? bytes[y * stride + x - channels] : 0;
      const up = y > 0 ? bytes[(y - 1) * stride + x] : 0;
      const corner = x >= channels && y > 0 ? bytes[(y - 1) * stride + x - channels] : 0;
      const guess = left + up - corner;
      const [a, b, c] = [left, up, corner].map((value) => Math.abs(guess - value));
      const paeth = a <= b && a <= c ? left : b <= c ? up : corner;
      bytes[y * stride + x] = raw[y * (stride + 1) + 1 + x] + [0, left, up, (left + up) >> 1, paeth][filter];
    }
  }
  return {width, height, channels, bytes};
}

/** How many different colours a picture has, to 4 bits a channel. */
function coloursOf({channels, bytes}) {
  const seen = new Set();
  for (let i = 0; i < bytes.length; i += channels) {
    seen.add((bytes[i] >> 4) << 8 | (bytes[i + 1] >> 4) << 4 | bytes[i + 2] >> 4);
  }
  return seen.size;
}

const path = findBrowser();
const folder = mkdtempSync(join(tmpdir(), 'tactus-report-'));
const run = join(folder, 'run');
const other = join(folder, 'other');
let browser;

function say(...words) {
  return execFileSync(tactus, words, {stdio: ['ignore', 'pipe', 'pipe'], cwd: folder});
}

before(() => {
  const stack = join(source, 'examples/explore_table/stack.xml');
  say('run', stack, '--out', run, '--duration', '60');
  say('run', stack, '--out', other, '--duration', '3', '--set', 'press=0.8');
  browser = new Browser(path, join(folder, 'profile'));
});

after(async () => {
  await browser.close();
  rmSync(folder, {recursive: true, force: true, maxRetries: 5});
});

test('errors of a page are seen', async () => {
  const file = join(folder, 'broken.html');
  writeFileSync(file, '<script>console.error("said"); throw new Error("thrown")</script><img src="http://127.0.0.1:9/x.png">');
  const page = await browser.open(pathToFileURL(file).href);
  assert.ok(page.complaints.some((text) => text.includes('said')));
  assert.ok(page.complaints.some((text) => text.includes('thrown')));
  assert.ok(page.requests.some((url) => url.startsWith('http:')));
});

test('a run of 60 s: a page below 25 MB that loads from disk, asks for nothing else and plays', async () => {
  const file = join(run, 'report.html');
  assert.ok(statSync(file).size < 25e6, `${statSync(file).size} bytes`);
  const page = await browser.open(pathToFileURL(file).href);
  assert.equal(await page.evaluate('tactus.clock.end >= 59.9'), true);
  assert.equal(await page.evaluate('tactus.views.length'), 1);
  assert.equal(await page.evaluate('tactus.plots[0].items.length'), 6);

  await page.click('.play');
  // It keeps the pace of the wall clock at any frame rate, however slow the machine draws.
  const [played, passed] = await page.evaluate(`new Promise((resolve) => {
    const start = performance.now(), from = tactus.clock.time;
    const look = () => {
      const passed = (performance.now() - start) / 1000;
      if (tactus.clock.time - from > 0.3 || passed > 120) resolve([tactus.clock.time - from, passed]);
      else setTimeout(look, 20);
    };
    look();
  })`);
  assert.ok(played > 0.3, `after ${passed} s it shows ${played} s`);
  assert.ok(played < passed + 1, `after ${passed} s it shows ${played} s`);
  await page.click('.play');
  assert.equal(await page.evaluate('tactus.clock.playing'), false);

  assert.deepEqual(page.complaints, []);
  assert.deepEqual(page.requests.filter((url) => !/^(file|data|blob):/.test(url)), []);
});

test('the scene is no blank, and moves with the slider', async () => {
  const page = await browser.open(pathToFileURL(join(run, 'report.html')).href);
  const at = async (time) => {
    await page.evaluate(`(() => { const slider = document.querySelector('.time'); slider.value = ${time};
      slider.dispatchEvent(new Event('input')); })()`);
    assert.equal(await page.evaluate("document.querySelector('output').textContent"), time.toFixed(2) + ' s');
    return page.picture('.picture canvas');
  };
  const start = await at(0);
  const busy = await at(12);
  assert.ok(coloursOf(start) > 30, `${coloursOf(start)} colours`);
  assert.ok(coloursOf(busy) > coloursOf(start) / 2);
  let changed = 0;
  for (let i = 0; i < busy.bytes.length; i += busy.channels) changed += Math.abs(busy.bytes[i] - start.bytes[i]) > 24;
  assert.ok(changed > 1000, `${changed} pixels changed`);
  assert.ok(await page.evaluate('tactus.views[0].touching') >= 1, 'some link touches at 12 s');
  assert.ok(await page.evaluate('tactus.views[0].arrows.filter((arrow) => arrow.visible).length') >= 1);
  assert.ok(await page.evaluate('tactus.views[0].touched.geometry.drawRange.count') > 100);
  assert.ok(coloursOf(await page.picture('.charts')) > 20);
});

test('a click in a plot moves the clock, and every plot shows it', async () => {
  const page = await browser.open(pathToFileURL(join(run, 'report.html')).href);
  await page.click('.plot:nth-child(2) .u-over');
  const time = await page.evaluate('tactus.clock.time');
  assert.ok(Math.abs(time - 30) < 0.5, `${time} s in the middle of 60 s`);
  const places = await page.evaluate("[...document.querySelectorAll('.now')].map((line) => line.style.transform)");
  assert.equal(places.length, 6);
  assert.equal(new Set(places).size, 1);
});

test('cameras look from elsewhere', async () => {
  const page = await browser.open(pathToFileURL(join(run, 'report.html')).href);
  const seen = new Set();
  for (let i = 1; i <= 5; ++i) {
    await page.click(`.presets button:nth-child(${i})`);
    seen.add(await page.evaluate('tactus.views[0].camera.position.toArray().map((x) => x.toFixed(3)).join()'));
  }
  assert.equal(seen.size, 5);
});

test('two runs side by side on one clock, with cameras that go together', async () => {
  say('report', run, '--beside', other);
  const page = await browser.open(pathToFileURL(join(run, 'beside-other.html')).href);
  assert.deepEqual(page.complaints, []);
  assert.equal(await page.evaluate('tactus.views.length'), 2);
  await page.evaluate('tactus.clock.seek(2)');
  assert.equal(await page.evaluate('tactus.views[1].run.frameAt(2)[0]'), 100);
  await page.evaluate(`tactus.views[0].camera.position.set(3, 0, 1); tactus.views[0].controls.update()`);
  assert.equal(await page.evaluate('tactus.views[1].camera.position.x === tactus.views[0].camera.position.x'), true);
});

test('points touched on an object that moves go with it', async () => {
  say('run', join(source, 'examples/hold_a_can/stack.xml'), '--out', join(folder, 'can'), '--duration', '2');
  const page = await browser.open(pathToFileURL(join(folder, 'can/report.html')).href);
  assert.deepEqual(page.complaints, []);
  const radius = 0.03;
  const [count, far] = await page.evaluate(`(() => { const {points} = tactus.views[0].clouds[1];
    const p = points.geometry.attributes.position;
    let far = 0;
    for (let i = 0; i < p.count; ++i) far += Math.abs(Math.hypot(p.getX(i), p.getY(i)) - ${radius}) > 0.006;
    return [p.count, far]; })()`);
  assert.ok(count > 30, `${count} points on the can`);
  assert.ok(far < 0.02 * count, `${far} of ${count} are off its wall`);
  const shown = async (time) => {
    await page.evaluate(`tactus.clock.seek(${time})`);
    return page.evaluate('tactus.views[0].clouds[1].points.geometry.drawRange.count');
  };
  assert.equal(await shown(0), 0);
  assert.equal(await shown(2), count);
  assert.equal(await page.evaluate('tactus.views[0].touched.geometry.attributes.position.count'), 0);
});

test('pictures for papers', () => {
  const pictures = join(folder, 'pictures');
  say('report', run, '--png', pictures, '--at', '12');
  for (const name of ['scene', 'plots', 'contacts', 'touched_points']) {
    const picture = decodePng(readFileSync(join(pictures, name + '.png')));
    assert.ok(picture.width >= 1800, `${name} is ${picture.width} pixels wide`);
    assert.ok(coloursOf(picture) > 10, `${name} has ${coloursOf(picture)} colours`);
  }
});
