/** What the page holds of a run, decoded: see replay_data.h for how it is written. */

/** Numbers of little-endian float32, base64. */
function floats(base64) {
  const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
  return new Float32Array(bytes.buffer);
}

/** The last index whose value is at most `value`; 0 where there is none.  `values` rise. */
export function indexAt(values, value) {
  let low = 0;
  let high = values.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (values[middle] <= value) low = middle;
    else high = middle - 1;
  }
  return low;
}

export class RunData {
  constructor(json) {
    this.title = json.title;
    this.scene = json.scene;
    this.notes = json.notes;
    this.features = json.features;
    this.columns = json.frames.columns;
    this.frames = floats(json.frames.data);
    this.width = this.columns.length;
    this.count = this.width ? this.frames.length / this.width : 0;
    this.times = Float32Array.from({length: this.count}, (_, i) => this.frames[i * this.width]);
    this.links = json.contacts.links;
    this.partners = json.contacts.on;
    this.contacts = floats(json.contacts.data);
    this.firstContact = this.#firstContacts();
    this.touched = floats(json.touched.data);
    this.plots = json.plots.map((plot) => ({...plot, series: plot.series.map((series) => ({
      label: series.label, values: floats(series.data)}))}));
  }

  /** Of the page, whatever there is of it. */
  static fromPage() {
    return [...document.querySelectorAll('script.run')].map((element) => new RunData(JSON.parse(element.textContent)));
  }

  /** [first, last] times that something is known of, or nothing. */
  span() {
    const times = [];
    if (this.count) times.push(this.times[0], this.times[this.count - 1]);
    for (const plot of this.plots) {
      const time = plot.series[0].values;
      if (time.length) times.push(time[0], time[time.length - 1]);
    }
    const finite = times.filter((time) => Number.isFinite(time) && Math.abs(time) < 1e9);
    return finite.length ? [Math.min(...finite), Math.max(...finite)] : null;
  }

  /** Index of the first column of a path, "link/palm" or "mark/sweep/key"; −1 where it does not move. */
  column(path) {
    return this.columns.indexOf(path + '/x');
  }

  /** Between which frames a time is, and how far it is on the way: [index, next, share]. */
  frameAt(time) {
    const index = indexAt(this.times, time);
    const next = Math.min(index + 1, this.count - 1);
    const step = this.times[next] - this.times[index];
    return [index, next, step > 0 ? Math.min(1, Math.max(0, (time - this.times[index]) / step)) : 0];
  }

  number(frame, column) {
    return this.frames[frame * this.width + column];
  }

  /** Contacts of a frame: {link, on, point, force}. */
  contactsOf(frame) {
    const found = [];
    for (let row = this.firstContact[frame]; row < this.firstContact[frame + 1]; ++row) {
      const [, link, on, ...numbers] = this.contacts.subarray(9 * row, 9 * row + 9);
      found.push({link: this.links[link], on: this.partners[on], point: numbers.slice(0, 3), force: numbers.slice(3)});
    }
    return found;
  }

  /** What each touched point lies on: of the touches around its time, that nearest to it; '' where there is none. */
  touchedOn() {
    const around = 3; // frames: a short touch may fall between two
    return Array.from({length: this.touched.length / 5}, (_, i) => {
      const [time, x, y, z] = this.touched.subarray(5 * i, 5 * i + 4);
      const frame = this.count ? this.frameAt(time)[0] : 0;
      const last = Math.min(this.count, frame + 1 + around);
      let [nearest, on] = [Infinity, ''];
      for (let row = this.firstContact[Math.max(0, frame - around)]; row < this.firstContact[last]; ++row) {
        const at = 9 * row;
        const distance = Math.hypot(this.contacts[at + 3] - x, this.contacts[at + 4] - y, this.contacts[at + 5] - z);
        if (distance < nearest) [nearest, on] = [distance, this.partners[this.contacts[at + 2]]];
      }
      return on;
    });
  }

  /** The force (N) that nine of ten contacts of the run stay below. */
  usualForce() {
    const forces = [];
    for (let row = 0; row < this.contacts.length; row += 9) {
      forces.push(Math.hypot(this.contacts[row + 6], this.contacts[row + 7], this.contacts[row + 8]));
    }
    forces.sort((a, b) => a - b);
    return forces.length ? forces[Math.floor(0.9 * (forces.length - 1))] : 1;
  }

  #firstContacts() {
    const first = new Uint32Array(this.count + 1);
    for (let row = 0; row < this.contacts.length; row += 9) ++first[this.contacts[row] + 1];
    for (let frame = 0; frame < this.count; ++frame) first[frame + 1] += first[frame];
    return first;
  }
}
