/** A small chart of the selected vehicle's speed and altitude over the last minute. */

import { number } from './format.js';

const LENGTH_S = 60;
const EVERY_S = 0.25;
const LEAST_PX = 54;
/** The lines, each with the smallest range of its axis, so that noise stays small. */
const LINES = [
  { key: 'speed', unit: 'km/h', least: 20, colour: '#e8b44c', dash: [] },
  { key: 'altitude', unit: 'm', least: 20, colour: '#6cacff', dash: [5, 3] },
];

export class Course {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d');
    this.id = 0;
    /** @type {{at: number, speed: number, altitude: number}[]} */
    this.samples = [];
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  /**
   * @param {any} me of a state
   * @param {number} at [s] of simulation
   */
  note(me, at) {
    const last = this.samples.at(-1);
    if (me.id !== this.id || (last && at < last.at)) this.samples = [];
    else if (last && at - last.at < EVERY_S) return;
    this.id = me.id;
    this.samples.push({ at, speed: me.speed_mps * 3.6, altitude: me.y });
    while (at - this.samples[0].at > LENGTH_S) this.samples.shift();
    this.draw();
  }

  draw() {
    const { canvas, context } = this;
    const { width, height } = canvas.getBoundingClientRect();
    const density = Math.min(devicePixelRatio || 1, 2);
    canvas.width = Math.max(Math.round(width * density), 1);
    canvas.height = Math.max(Math.round(height * density), 1);
    if (height < LEAST_PX || this.samples.length < 2) return;
    context.scale(density, density);
    context.font = '11px system-ui, "DejaVu Sans", sans-serif';
    context.strokeStyle = '#212b34';
    context.strokeRect(0.5, 18.5, width - 1, height - 19);
    let x = 2;
    for (const line of LINES) x = this.drawLine(line, x, width, height);
    context.fillStyle = '#97a5b1';
    context.textAlign = 'right';
    context.fillText('the last minute', width - 2, 12);
    context.textAlign = 'left';
  }

  /** @returns {number} where the next line's text begins */
  drawLine({ key, unit, least, colour, dash }, x, width, height) {
    const { context, samples } = this;
    const values = samples.map((sample) => sample[key]);
    const low = Math.min(...values), high = Math.max(...values);
    const range = Math.max(high - low, least), from = (low + high - range) / 2;
    const end = samples.at(-1).at;
    context.beginPath();
    for (const sample of samples) {
      const px = width - 4 - ((end - sample.at) / LENGTH_S) * (width - 8);
      context.lineTo(px, height - 6 - ((sample[key] - from) / range) * (height - 32));
    }
    context.strokeStyle = context.fillStyle = colour;
    context.lineWidth = 1.6;
    context.setLineDash(dash);
    context.stroke();
    context.beginPath();
    context.moveTo(x, 8);
    context.lineTo(x + 20, 8);
    context.stroke();
    context.setLineDash([]);
    const words = `${key} ${number(low)} to ${number(high)} ${unit}`;
    context.fillText(words, x + 25, 12);
    return x + 25 + context.measureText(words).width + 16;
  }
}
