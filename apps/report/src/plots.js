import uPlot from 'uplot';

import {lines} from './palette.js';
import {indexAt} from './run_data.js';

const ink = '#444';
const rule = '#e8e8e3';
const whole = [1, 10, 100, 1000, 10000].flatMap((power) => [power, 2 * power, 5 * power]); // steps of what is counted

function text(value) {
  if (value == null || !Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e5)) return value.toExponential(1).replace('.0e', 'e').replace('e+', 'e');
  return String(Number(value.toPrecision(3)));
}

/** Lowest and highest value of all, those that can be drawn. */
function extent(plots) {
  let low = Infinity;
  let high = -Infinity;
  for (const plot of plots) {
    for (const series of plot.series.slice(1)) {
      for (const value of series.values) {
        if (!Number.isFinite(value) || Math.abs(value) > 1e12 || (plot.scale === 'log' && value <= 0)) continue;
        low = Math.min(low, value);
        high = Math.max(high, value);
      }
    }
  }
  return low <= high ? [low, high] : [0, 1];
}

function rangeOf(plots) {
  const [low, high] = extent(plots);
  if (plots[0].scale === 'log') {
    return [10 ** Math.floor(Math.log10(Math.max(low, high * 1e-7))), 10 ** Math.ceil(Math.log10(high) + 1e-9)];
  }
  const bottom = Math.min(0, low);
  const top = Math.max(high, plots[0].wanted || 0, plots[0].stepped ? 1 : 0);
  return [bottom, top + 0.06 * (top - bottom || 1)];
}

/** Plots of one run below one another; a click or drag in one moves the clock, which moves the line in all. */
export class Plots {
  /** `others`: the same kinds of plots of every run on the page, which share their ranges with these. */
  constructor(host, run, clock, others) {
    this.clock = clock;
    this.items = run.plots.map((plot) => this.#make(host, plot, others.flat().filter((one) => one.title === plot.title)));
    clock.listen(() => this.show(clock.time));
  }

  #make(host, plot, alike) {
    const box = document.createElement('div');
    box.className = 'plot';
    const head = document.createElement('div');
    head.className = 'key';
    const title = document.createElement('b');
    title.textContent = plot.title;
    head.append(title);
    const body = document.createElement('div');
    body.className = 'lines';
    box.append(head, body);
    host.append(box);

    const [time, ...values] = plot.series;
    const paths = plot.stepped ? uPlot.paths.stepped({align: 1}) : uPlot.paths.linear();
    const drawable = (value) => (Number.isFinite(value) && Math.abs(value) <= 1e12 && (plot.scale !== 'log' || value > 0)
      ? value : null);
    const series = values.map(({label}, i) => ({label, stroke: lines[i % lines.length], width: 1.4, paths,
      points: {show: false}}));
    const data = [time.values, ...values.map((one) => Array.from(one.values, drawable))];
    if (plot.wanted != null) {
      series.push({label: 'wanted', stroke: ink, width: 1, dash: [5, 4], paths: uPlot.paths.linear(), points: {show: false}});
      data.push(Array.from(time.values, () => plot.wanted));
    }
    const range = rangeOf(alike);
    const step = Math.ceil(Math.log10(range[1] / range[0]) / 4);
    const decades = (_, splits) => splits.map((value) => (Math.abs(Math.log10(value) / step % 1) < 1e-6 ? value : null));
    const axis = {stroke: ink, grid: {stroke: rule, width: 1}, ticks: {stroke: rule, width: 1}, font: '11px system-ui'};
    const chart = new uPlot({
      width: 400,
      height: 110,
      legend: {show: false},
      cursor: {show: false},
      scales: {x: {time: false, range: () => [this.clock.start, this.clock.end]},
        y: {distr: plot.scale === 'log' ? 3 : 1, range: () => range}},
      axes: [{...axis, size: 22, gap: 2}, {...axis, size: 46, gap: 3, space: 22,
        ...(plot.scale === 'log' ? {filter: decades, grid: {...axis.grid, filter: decades}, ticks: {...axis.ticks, filter: decades}} : {}),
        ...(plot.stepped ? {incrs: whole} : {}),
        values: (_, splits) => splits.map((value) => (value == null ? '' : text(value)))}],
      series: [{}, ...series],
      padding: [6, 8, 0, 0],
    }, data, body);
    const now = document.createElement('div');
    now.className = 'now';
    chart.over.append(now);

    const seek = (event) => {
      if (event.buttons !== 1) return;
      const left = event.clientX - chart.over.getBoundingClientRect().left;
      this.clock.seek(chart.posToVal(left, 'x'));
    };
    chart.over.addEventListener('pointerdown', (event) => {
      chart.over.setPointerCapture(event.pointerId);
      seek(event);
    });
    chart.over.addEventListener('pointermove', seek);

    const readings = series.map((one, i) => {
      const key = document.createElement('button');
      key.type = 'button';
      key.style.setProperty('--line', one.stroke);
      const value = document.createElement('i');
      key.append(document.createElement('span'), one.label, ' ', value);
      key.addEventListener('click', () => {
        const hidden = chart.series[i + 1].show;
        chart.setSeries(i + 1, {show: !hidden});
        key.classList.toggle('off', hidden);
      });
      head.append(key);
      return value;
    });
    new ResizeObserver(() => {
      if (!body.clientWidth) return;
      chart.setSize({width: body.clientWidth, height: body.clientHeight});
      this.show(this.clock.time);
    }).observe(body);
    return {chart, now, data, readings};
  }

  show(time) {
    for (const {chart, now, data, readings} of this.items) {
      now.style.transform = `translateX(${chart.valToPos(time, 'x')}px)`;
      const index = data[0].length ? indexAt(data[0], time + 1e-6) : -1;
      readings.forEach((reading, i) => {
        reading.textContent = index < 0 ? '–' : text(data[i + 1][index]);
      });
    }
  }
}
