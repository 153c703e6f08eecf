// A run as MCAP, read back by MCAP's own library: streamed and by index, all checksums and schemas checked, and the
// values held against the files they are from.  Exit code 77, which CTest counts as skipped, where that library is not
// installed.
//
//   node mcap_export.mjs TACTUS SOURCE_FOLDER NODE_MODULES

import assert from 'node:assert/strict';
import {execFileSync, spawnSync} from 'node:child_process';
import {cpSync, existsSync, mkdtempSync, readFileSync, rmSync, truncateSync, statSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';

const [tactus, source, modules] = process.argv.slice(-3);

function load() {
  const require = createRequire(join(modules, 'any.js'));
  try {
    return {...require('@mcap/core'), Ajv: require('ajv').default, published: require('@foxglove/schemas/jsonschema'),
      crc32: require('@foxglove/crc').crc32};
  } catch (error) {
    console.log(`skipped: ${error.message.split('\n')[0]}; npm installs it with the packages of apps/report`);
    process.exit(77);
  }
}

const {McapIndexedReader, McapStreamReader, Ajv, published, crc32} = load();
const folder = mkdtempSync(join(tmpdir(), 'tactus-mcap-'));
after(() => rmSync(folder, {recursive: true, force: true}));

function say(...words) {
  return execFileSync(tactus, words, {stdio: ['ignore', 'pipe', 'pipe'], cwd: folder});
}

/** Rows of a CSV file as texts. */
function table(run, name) {
  const [head, ...rows] = readFileSync(join(folder, run, name), 'utf8').trimEnd().split('\n');
  return {columns: head.split(','), rows: rows.map((row) => row.split(','))};
}

/** All records from beginning to end; the reader checks the checksums of chunks and data. */
function streamed(bytes) {
  const reader = new McapStreamReader({validateCrcs: true, includeChunks: true});
  reader.append(bytes);
  const records = [];
  for (let record; (record = reader.nextRecord());) records.push(record);
  assert.ok(reader.done());
  return records;
}

async function indexed(bytes) {
  return McapIndexedReader.Initialize({readable: {
    size: async () => BigInt(bytes.length),
    read: async (offset, length) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + length)))}});
}

const parse = (message) => JSON.parse(new TextDecoder('utf8', {fatal: true}).decode(message.data));
const nanoseconds = (text) => BigInt(Math.round(Number(text) * 1e9));

/** Messages by topic, as a streaming reader sees them. */
function topicsOf(records) {
  const topics = new Map();
  const channels = new Map();
  for (const record of records) {
    if (record.type === 'Channel') {
      channels.set(record.id, record);
      if (!topics.has(record.topic)) topics.set(record.topic, []);
    }
    if (record.type === 'Message') topics.get(channels.get(record.channelId).topic).push(record);
  }
  return topics;
}

/** A schema less what says nothing about messages, its keys in order. */
function bare(schema) {
  if (Array.isArray(schema)) return schema.map(bare);
  if (schema === null || typeof schema !== 'object') return schema;
  return Object.fromEntries(Object.keys(schema).filter((key) => key !== 'description' && key !== '$comment').sort()
    .map((key) => [key, bare(schema[key])]));
}

let bytes, records, topics;

before(() => {
  say('run', join(source, 'examples/explore_table/stack.xml'), '--out', 'run', '--duration', '5');
  say('run', join(source, 'examples/hold_a_can/stack.xml'), '--out', 'can', '--duration', '1');
  say('export', 'run', '--mcap', 'run.mcap');
  bytes = readFileSync(join(folder, 'run.mcap'));
  records = streamed(bytes);
  topics = topicsOf(records);
});

test('the checksums of data and summary are right, and a changed byte is found', async () => {
  const reader = await indexed(bytes);
  const end = Number(reader.dataEndOffset);
  const data_end = records.find((record) => record.type === 'DataEnd');
  assert.equal(crc32(bytes.subarray(0, end)), data_end.dataSectionCrc);
  const footer = records.find((record) => record.type === 'Footer');
  assert.equal(crc32(bytes.subarray(Number(footer.summaryStart), bytes.length - 8 - 4)), footer.summaryCrc);

  const broken = Buffer.from(bytes);
  broken[Math.floor(end / 2)] ^= 1;
  assert.throws(() => streamed(broken), /CRC/i);
});

test('both readers find the same messages in the same order, and the statistics count them', async () => {
  const reader = await indexed(bytes);
  const messages = records.filter((record) => record.type === 'Message');
  let count = 0;
  for await (const message of reader.readMessages()) {
    const other = messages[count++];
    assert.equal(message.channelId, other.channelId);
    assert.equal(message.logTime, other.logTime);
    assert.ok(Buffer.from(message.data).equals(Buffer.from(other.data)));
  }
  assert.equal(count, messages.length);
  assert.equal(reader.statistics.messageCount, BigInt(count));
  assert.equal(reader.statistics.chunkCount, records.filter((record) => record.type === 'Chunk').length);
  assert.equal(reader.chunkIndexes.length, reader.statistics.chunkCount);
  assert.ok(reader.chunkIndexes.length > 1, 'more than one chunk');
  assert.equal(reader.statistics.channelCount, topics.size);
  for (const [id, channel] of reader.channelsById) {
    const counted = reader.statistics.channelMessageCounts.get(id);
    assert.equal(counted, BigInt(topics.get(channel.topic).length), channel.topic);
  }
  assert.deepEqual([...reader.summaryOffsetsByOpcode.keys()].sort((a, b) => a - b), [3, 4, 8, 11, 13]);
  const facts = [];
  for await (const one of reader.readMetadata()) facts.push([one.name, Object.fromEntries(one.metadata)]);
  assert.deepEqual(facts, [['run', {stack: 'explore-table', backend: 'null-space', seed: '1', status: 'done'}]]);

  // A jump in time reads what is there, and no more.
  const some = [];
  const wanted = {topics: ['/contact'], startTime: 2_000_000_000n, endTime: 2_090_000_000n};
  for await (const message of reader.readMessages(wanted)) {
    some.push(Number(message.logTime) / 1e9);
  }
  assert.deepEqual(some, [2, 2.01, 2.02, 2.03, 2.04, 2.05, 2.06, 2.07, 2.08, 2.09]);
});

test('every message keeps its schema, and Foxglove\'s are those that it publishes', async () => {
  const reader = await indexed(bytes);
  const ajv = new Ajv({strict: false, allErrors: true});
  for (const [id, schema] of reader.schemasById) {
    assert.equal(schema.encoding, 'jsonschema');
    const json = JSON.parse(new TextDecoder().decode(schema.data));
    const name = schema.name.match(/^foxglove\.(.*)/)?.[1];
    if (name) assert.deepEqual(bare(json), bare(published[name]), schema.name);
    const validate = ajv.compile(json);
    for (const channel of reader.channelsById.values()) {
      if (channel.schemaId !== id) continue;
      assert.equal(channel.messageEncoding, 'json');
      for (const message of topics.get(channel.topic)) {
        assert.ok(validate(parse(message)), `${channel.topic}: ${ajv.errorsText(validate.errors)}`);
      }
    }
  }
  const names = [...reader.channelsById.values()].map((channel) => reader.schemasById.get(channel.schemaId).name);
  for (const name of ['SceneUpdate', 'FrameTransforms', 'PointCloud']) {
    assert.ok(names.includes('foxglove.' + name), name);
  }
});

test('every number of log.csv is there, at its time, under the name of its column', () => {
  const log = table('run', 'log.csv');
  assert.ok(log.rows.length === 500);
  let seen = 0;
  log.columns.forEach((column, at) => {
    if (column === 'time') return;
    const slash = column.lastIndexOf('/');
    const messages = topics.get('/' + column.slice(0, slash));
    assert.equal(messages.length, log.rows.length, column);
    messages.forEach((message, row) => {
      assert.equal(message.logTime, nanoseconds(log.rows[row][0]));
      assert.equal(message.publishTime, message.logTime);
      assert.equal(message.sequence, row);
      const value = Number(log.rows[row][at]);
      const told = parse(message)[column.slice(slash + 1)];
      if (Number.isFinite(value)) assert.equal(told, value, column);
      else assert.equal(told, undefined, column);
      ++seen;
    });
  });
  assert.equal(seen, (log.columns.length - 1) * log.rows.length);
});

test('frames and contacts are those of the replay', () => {
  const replay = table('run', 'replay.csv');
  const scene = JSON.parse(readFileSync(join(folder, 'run/scene.json')));
  const transforms = topics.get('/tf').map(parse);
  assert.equal(transforms.length, replay.rows.length);
  transforms.forEach(({transforms: of}, row) => {
    assert.deepEqual(of.map((one) => one.child_frame_id).sort(),
      [...scene.links, ...scene.objects.filter((one) => one.moves)].map((one) => one.name).sort());
    for (const one of of) {
      assert.equal(one.parent_frame_id, 'world');
      const at = replay.columns.indexOf(`link/${one.child_frame_id}/x`);
      const pose = at < 0 ? scene.links.find((link) => link.name === one.child_frame_id).pose
        : replay.rows[row].slice(at, at + 7).map(Number);
      const {translation: p, rotation: q} = one;
      assert.deepEqual([p.x, p.y, p.z, q.w, q.x, q.y, q.z], pose);
    }
  });

  const touches = table('run', 'replay_contacts.csv');
  const arrows = topics.get('/contacts').map(parse);
  assert.equal(arrows.length, replay.rows.length);
  assert.ok(touches.rows.length > 50);
  let next = 0;
  arrows.forEach(({entities: [one]}, row) => {
    assert.equal(one.frame_id, 'world');
    one.arrows.forEach((arrow, k) => {
      const [time, link, on, ...numbers] = touches.rows[next++];
      assert.equal(time, replay.rows[row][0]);
      assert.equal(one.metadata[k].key, `${link} on ${on}`);
      const [x, y, z, ...force] = numbers.map(Number);
      const size = Math.hypot(...force);
      // Along its own x axis it ends where the link touches, and points as the force does.
      const {position: p, orientation: {x: a, y: b, z: c, w}} = arrow.pose;
      const along = [1 - 2 * (b * b + c * c), 2 * (a * b + c * w), 2 * (a * c - b * w)];
      const length = arrow.shaft_length + arrow.head_length;
      [x, y, z].forEach((tip, i) => {
        assert.ok(Math.abs([p.x, p.y, p.z][i] + length * along[i] - tip) < 1e-5);
        assert.ok(Math.abs(along[i] - force[i] / size) < 1e-5);
      });
      assert.ok(Math.abs(Number(one.metadata[k].value.replace(' N', '')) - size) < 1e-3 * size);
    });
  });
  assert.equal(next, touches.rows.length);
});

test('a jump to any time finds the whole cloud touched until then', () => {
  const touched = table('run', 'touched_points.csv');
  const clouds = topics.get('/touched');
  const numbers = (message) => {
    const raw = Buffer.from(parse(message).data, 'base64');
    return new Float32Array(raw.buffer.slice(raw.byteOffset, raw.byteOffset + raw.length));
  };
  const last = numbers(clouds.at(-1));
  assert.equal(last.length, 5 * touched.rows.length);
  touched.rows.forEach((row, i) => {
    for (const axis of [0, 1, 2]) assert.equal(last[5 * i + axis], Math.fround(Number(row[2 + axis])));
    assert.equal(last[5 * i + 4], Math.fround(Number(row[8])));
  });
  for (const message of clouds) {
    const count = touched.rows.filter((row) => nanoseconds(row[0]) <= message.logTime).length;
    assert.equal(numbers(message).length, 5 * count);
  }
  // What is touched between two messages is less than a fiftieth of the cloud.
  clouds.slice(1).forEach((message, i) => {
    const before = numbers(clouds[i]).length / 5;
    const missing = touched.rows.filter((row) => nanoseconds(row[0]) < message.logTime).length - before;
    assert.ok(missing < Math.max(1, 0.02 * before), `${missing} of ${before}`);
  });
});

test('an object that moves has a frame of its name, one that stands still is in the world', () => {
  say('export', 'can', '--mcap', 'can.mcap');
  const can = topicsOf(streamed(readFileSync(join(folder, 'can.mcap'))));
  const scene = JSON.parse(readFileSync(join(folder, 'can/scene.json')));
  const drawn = new Map(parse(can.get('/scene')[0]).entities.map((one) => [one.id, one]));
  for (const object of scene.objects) {
    const one = drawn.get('object/' + object.name);
    assert.equal(one.frame_id, object.moves ? object.name : 'world');
    const {position: p} = one.triangles[0].pose;
    assert.deepEqual([p.x, p.y, p.z], object.moves ? [0, 0, 0] : object.pose.slice(0, 3));
    assert.equal(one.triangles[0].points.length, object.vertices.length / 3);
    assert.deepEqual(one.triangles[0].indices, object.triangles);
  }
  const moving = scene.objects.filter((one) => one.moves);
  assert.ok(moving.length > 0);
  const replay = table('can', 'replay.csv');
  const at = replay.columns.indexOf(`object/${moving[0].name}/z`);
  can.get('/tf').forEach((message, row) => {
    const frame = parse(message).transforms.find((one) => one.child_frame_id === moving[0].name);
    assert.equal(frame.translation.z, Number(replay.rows[row][at]));
  });
});

test('the same run gives the same bytes', () => {
  say('run', join(source, 'examples/explore_table/stack.xml'), '--out', 'again', '--duration', '5');
  say('export', 'again', '--mcap', 'again.mcap');
  assert.ok(bytes.equals(readFileSync(join(folder, 'again.mcap'))));
});

test('a run that was cut off is whole as far as it came', () => {
  cpSync(join(folder, 'run'), join(folder, 'cut'), {recursive: true});
  const run = JSON.parse(readFileSync(join(folder, 'cut/run.json')));
  writeFileSync(join(folder, 'cut/run.json'), JSON.stringify({...run, status: 'running'}));
  for (const name of ['log.csv', 'replay.csv', 'replay_contacts.csv', 'touched_points.csv']) {
    const file = join(folder, 'cut', name);
    truncateSync(file, Math.floor(0.7 * statSync(file).size));
  }
  const outcome = spawnSync(tactus, ['export', 'cut', '--mcap', 'cut.mcap'], {cwd: folder, encoding: 'utf8'});
  assert.equal(outcome.status, 0, outcome.stderr);
  assert.match(outcome.stderr, /warning: cut\/log\.csv ends within a line/);
  const cut = topicsOf(streamed(readFileSync(join(folder, 'cut.mcap'))));
  const rows = table('cut', 'log.csv').rows.length - 1;            // the last one is no row
  assert.equal(cut.get('/contact').length, rows);
  assert.ok(cut.get('/tf').length > 100);
});

test('what cannot be written leaves nothing behind', () => {
  const shell = (words, command) =>
    spawnSync('sh', ['-c', command, 'sh', tactus, ...words], {cwd: folder, encoding: 'utf8'});
  const full = shell(['export', 'run', '--mcap', 'full.mcap'], 'ulimit -f 64; exec "$@"');
  assert.equal(full.status, 6);
  assert.match(full.stderr, /full\.mcap: cannot be written: File too large/);
  assert.ok(!existsSync(join(folder, 'full.mcap')) && !existsSync(join(folder, 'full.mcap.new')));
  const nowhere = shell(['export', 'run', '--mcap', 'none/x.mcap'], 'exec "$@"');
  assert.equal(nowhere.status, 6);
  assert.match(nowhere.stderr, /none\/x\.mcap: cannot be created/);
  assert.equal(shell(['export', 'none', '--mcap', 'x.mcap'], 'exec "$@"').status, 6);
  assert.equal(shell(['export', 'run'], 'exec "$@"').status, 2);
});
