/** The one time that all of the page shows, s.  Listeners are told of every change. */
export class Clock {
  constructor(start, end) {
    this.start = start;
    this.end = end;
    this.time = start;
    this.speed = 1;
    this.playing = false;
    this.listeners = [];
  }

  listen(listener) {
    this.listeners.push(listener);
  }

  tell() {
    for (const listener of this.listeners) listener(this);
  }

  seek(time) {
    this.time = Math.min(this.end, Math.max(this.start, time));
    this.tell();
  }

  setSpeed(speed) {
    this.speed = speed;
    this.tell();
  }

  /** From the start again where it had come to the end. */
  play() {
    if (this.playing) return;
    if (this.time >= this.end) this.time = this.start;
    this.playing = true;
    let last = performance.now();
    const step = (now) => {
      if (!this.playing) return;
      const passed = Math.max(0, now - last) / 1000;
      last = now;
      if (this.time + passed * this.speed >= this.end) this.playing = false;
      this.seek(this.time + passed * this.speed);
      if (this.playing) requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
    this.tell();
  }

  pause() {
    this.playing = false;
    this.tell();
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }
}
