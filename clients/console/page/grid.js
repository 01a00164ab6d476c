/** Draws the grid, the scale and text over the map. */

import { distance } from './format.js';

const GRID_PX = 90;
const STEPS_M = [10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000];
const FONT = '11px system-ui, "DejaVu Sans", sans-serif';

/** Draws text with a dark rim. */
export function drawLabel(context, words, x, y) {
  context.lineWidth = 3;
  context.lineJoin = 'round';
  context.strokeStyle = 'rgba(10, 14, 18, 0.8)';
  context.strokeText(words, x, y);
  context.fillStyle = 'rgba(230, 238, 245, 0.85)';
  context.fillText(words, x, y);
}

/**
 * Draws lines at round distances, with kilometres at the edges.
 * @param {CanvasRenderingContext2D} context
 * @param {import('./camera.js').Camera} camera
 * @param {boolean} bare there is no ground below it
 */
export function drawGrid(context, camera, bare) {
  const step = STEPS_M.find((m) => m / camera.scale >= GRID_PX) ?? STEPS_M.at(-1);
  const [x0, z0, x1, z1] = camera.area();
  const first = (least) => Math.max(Math.ceil(least / step), 0) * step;
  const text = (m) => String(Math.round(m) / 1000);
  /** @type {[string, number, number][]} */
  const labels = [];
  context.beginPath();
  for (let x = first(x0); x <= Math.min(x1, camera.side); x += step) {
    const px = Math.round(camera.px(x)) + 0.5;
    context.moveTo(px, camera.py(0));
    context.lineTo(px, camera.py(camera.side));
    labels.push([text(x), px + 3, camera.height - 16]);
  }
  for (let z = first(z0); z <= Math.min(z1, camera.side); z += step) {
    const py = Math.round(camera.py(z)) + 0.5;
    context.moveTo(camera.px(0), py);
    context.lineTo(camera.px(camera.side), py);
    if (py < camera.height - 40 && py > 44) labels.push([text(z), 4, py + 2]);
  }
  context.strokeStyle = bare ? 'rgba(230, 238, 245, 0.13)' : 'rgba(10, 14, 18, 0.35)';
  context.lineWidth = 1;
  context.stroke();
  context.font = FONT;
  context.textBaseline = 'top';
  for (const [label, x, y] of labels) drawLabel(context, label, x, y);
}

/** Draws a scale bar of a round length at the lower right. */
export function drawScaleBar(context, camera) {
  const most = Math.min(150, camera.width / 4) * camera.scale;
  const power = 10 ** Math.floor(Math.log10(most));
  const length = [5, 2, 1].map((n) => n * power).find((m) => m <= most) ?? power;
  const pixels = length / camera.scale, x = camera.width - pixels - 12, y = camera.height - 30;
  context.fillStyle = 'rgba(10, 14, 18, 0.8)';
  context.fillRect(x - 2, y - 2, pixels + 4, 8);
  for (let i = 0; i < 4; i++) {
    context.fillStyle = i % 2 ? '#11171c' : '#f0f2ee';
    context.fillRect(x + (i * pixels) / 4, y, pixels / 4, 4);
  }
  context.font = FONT;
  context.textAlign = 'right';
  drawLabel(context, distance(length), camera.width - 12, y - 16);
  context.textAlign = 'left';
}
