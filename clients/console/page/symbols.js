/**
 * Symbols of the map, the same as the renderer's. The shape shows the kind; the colour and the rim
 * show the force, so that colour-blind people can tell it as well. The blue force is blue with a
 * dark rim, the red force red with a pale rim, the neutral force yellow with a dark rim.
 */

/** Corners in units of the symbol's length, forward and to the right; each piece is convex. */
const FORMS = {
  land: [1, [[0.62, 0, -0.42, 0.42, -0.42, -0.42]]],
  air: [1.1, [[0.6, 0.12, -0.5, -0.58, -0.2, 0.12], [0.6, -0.12, -0.5, 0.58, -0.2, -0.12]]],
  sea: [1.4, [[0.65, 0, 0.2, 0.22, -0.55, 0.22, -0.55, -0.22, 0.2, -0.22]]],
  tank: [1, [[0.3, 0.34, -0.5, 0.34, -0.5, -0.34, 0.3, -0.34]]],
  carrier: [1, [[0.62, 0, 0.25, 0.36, -0.5, 0.36, -0.5, -0.36, 0.25, -0.36]]],
  truck: [1.05, [[0.62, 0.2, 0.34, 0.24, 0.34, -0.24, 0.62, -0.2], [0.16, 0.3, -0.62, 0.3, -0.62, -0.3, 0.16, -0.3]]],
  jeep: [0.9, [[0.6, 0.08, -0.15, 0.08, -0.45, -0.42], [0.6, -0.08, -0.15, -0.08, -0.45, 0.42]]],
  helicopter: [1.15, [
    [0.46, 0.36, 0.36, 0.46, -0.46, -0.36, -0.36, -0.46], [0.46, -0.36, 0.36, -0.46, -0.46, 0.36, -0.36, 0.46],
    [0.4, 0, 0.2, 0.17, -0.2, 0.15, -0.35, 0, -0.2, -0.15, 0.2, -0.17], [0, 0.06, -0.75, 0.04, -0.75, -0.04, 0, -0.06]]],
  jet: [1.25, [[0.7, 0, 0.2, 0.1, -0.5, 0, 0.2, -0.1], [0.2, 0, -0.28, 0.5, -0.42, 0.5, -0.22, 0],
    [0.2, 0, -0.28, -0.5, -0.42, -0.5, -0.22, 0]]],
};
const GUN = [0.85, 0.08, 0.1, 0.08, 0.1, -0.08, 0.85, -0.08];

/** By enum force: neutral, blue, red. */
export const FILL = ['#ffe260', '#4f9bff', '#f0432b'];
const RIM = ['#282004', '#040e30', '#ffeee4'];
/** Colours of text on a dark background. */
export const FORCE_CLASS = ['neutral', 'blue', 'red'];

function outline(corners) {
  let path = '';
  for (let i = 0; i < corners.length; i += 2) {
    path += `${i ? 'L' : 'M'}${corners[i + 1]} ${-corners[i]}`;
  }
  return `${path}Z`;
}

const PATHS = Object.fromEntries(Object.entries(FORMS).map(
  ([form, [scale, pieces]]) => [form, { scale, path: new Path2D(pieces.map(outline).join('')) }]));
const GUN_PATH = new Path2D(outline(GUN));

/** @param {{name: string, domain: string}} kind @returns {string} a key of FORMS */
export function formOf(kind) {
  if (kind.name in FORMS) return kind.name;
  if (kind.name === 'helo-cow') return 'helicopter';
  return kind.domain === 'air' ? 'air' : kind.domain === 'sea' ? 'sea' : 'land';
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {string} form
 * @param {number} x
 * @param {number} y
 * @param {number} heading [rad] clockwise from up
 * @param {number} pixels about its length
 * @param {number} force
 * @param {number} turret [rad] off the heading; for what has a gun to show
 */
export function drawVehicle(context, form, x, y, heading, pixels, force, turret) {
  const { scale, path } = PATHS[form];
  const size = pixels * scale;
  context.save();
  context.translate(x, y);
  context.rotate(heading);
  context.scale(size, size);
  context.lineJoin = 'round';
  context.lineWidth = 0.2;
  context.strokeStyle = RIM[force];
  context.fillStyle = FILL[force];
  context.stroke(path);
  context.fill(path);
  if (form === 'tank') {
    context.rotate(turret);
    context.lineWidth = 0.14;
    context.stroke(GUN_PATH);
    context.fill(GUN_PATH);
  }
  context.restore();
}

/** Draws a wreck: a black cross on a pale ground. */
export function drawWreck(context, x, y, pixels) {
  const half = 0.3 * pixels;
  for (const [style, width] of [['rgba(235, 225, 205, 0.7)', 3.2], ['#0a0806', 1.6]]) {
    context.strokeStyle = style;
    context.lineWidth = width;
    context.beginPath();
    context.moveTo(x - half, y - half);
    context.lineTo(x + half, y + half);
    context.moveTo(x - half, y + half);
    context.lineTo(x + half, y - half);
    context.stroke();
  }
}

/** Draws a munition in flight: a pale dot with a tail. */
export function drawMunition(context, x, y, heading) {
  context.strokeStyle = 'rgba(255, 245, 200, 0.6)';
  context.lineWidth = 1.2;
  context.beginPath();
  context.moveTo(x - 9 * Math.sin(heading), y + 9 * Math.cos(heading));
  context.lineTo(x, y);
  context.stroke();
  context.fillStyle = '#14100a';
  context.fillRect(x - 2.5, y - 2.5, 5, 5);
  context.fillStyle = '#fffae1';
  context.fillRect(x - 1.5, y - 1.5, 3, 3);
}

/** Draws a recent event; age 0: now, 1: invisible. */
export function drawBlast(context, x, y, age, pixels) {
  const reach = pixels * (0.7 + 0.6 * age);
  context.save();
  context.globalAlpha = 1 - age;
  context.translate(x, y);
  context.rotate(0.3);
  context.fillStyle = '#fffad2';
  context.strokeStyle = '#ff7800';
  context.lineWidth = 1.5;
  context.beginPath();
  for (let i = 0; i < 8; i++) {
    const length = i % 2 ? 0.2 * reach : 0.75 * reach;
    context.lineTo(length * Math.cos((i * Math.PI) / 4), length * Math.sin((i * Math.PI) / 4));
  }
  context.closePath();
  context.stroke();
  context.fill();
  context.restore();
}
