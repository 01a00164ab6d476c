/** Gestures on the map: drag, wheel, pinch, click, double click, and the keyboard. */

const CLICK_PX = 5;
const KEY_PX = 60;
const KEY_ZOOM = 1.3;

/**
 * @param {import('./map.js').MapView} map
 * @param {{click: (px: number, py: number, again: boolean) => void,
 *   hover: (px: number, py: number) => void, moved: () => void}} handlers
 */
export function listen(map, handlers) {
  const { canvas, camera } = map;
  /** @type {Map<number, {x: number, y: number}>} */
  const held = new Map();
  let travelled = 0;
  let clicked = 0;
  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };

  canvas.addEventListener('pointerdown', (event) => {
    if (event.button !== 0) return;
    canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, place(event));
    map.held = true;
    if (held.size === 1) travelled = 0;
  });

  canvas.addEventListener('pointermove', (event) => {
    const at = place(event);
    const from = held.get(event.pointerId);
    if (!from) {
      handlers.hover(at.x, at.y);
      return;
    }
    travelled += Math.hypot(at.x - from.x, at.y - from.y);
    if (held.size === 2) {
      const other = [...held].find(([id]) => id !== event.pointerId)[1];
      const before = Math.hypot(from.x - other.x, from.y - other.y);
      const after = Math.hypot(at.x - other.x, at.y - other.y);
      if (after > 1) camera.zoom(before / after, (at.x + other.x) / 2, (at.y + other.y) / 2);
    }
    if (travelled > CLICK_PX) {
      camera.pan((at.x - from.x) / held.size, (at.y - from.y) / held.size);
      handlers.moved();
    }
    held.set(event.pointerId, at);
    map.touch();
  });

  const end = (event) => {
    const was = held.delete(event.pointerId);
    map.held = held.size > 0;
    if (!was || event.type === 'pointercancel') return;
    if (travelled > CLICK_PX || held.size > 0) return;
    const at = place(event);
    const again = event.timeStamp - clicked < 350;
    clicked = again ? 0 : event.timeStamp;
    handlers.click(at.x, at.y, again);
  };
  canvas.addEventListener('pointerup', end);
  canvas.addEventListener('pointercancel', end);

  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    const at = place(event);
    const pixels = event.deltaMode === 1 ? event.deltaY * 30 : event.deltaY;
    camera.zoom(Math.exp(Math.min(Math.max(pixels, -300), 300) * 0.0016), at.x, at.y);
    map.touch();
  }, { passive: false });

  canvas.addEventListener('keydown', (event) => {
    const moves = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const zooms = { '+': 1 / KEY_ZOOM, '=': 1 / KEY_ZOOM, '-': KEY_ZOOM };
    const move = moves[event.key], zoom = zooms[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey || !(move || zoom)) return;
    event.preventDefault();
    event.stopPropagation();
    if (zoom) camera.zoom(zoom);
    if (move) {
      camera.pan(move[0] * KEY_PX, move[1] * KEY_PX);
      handlers.moved();
    }
    map.touch();
  });
}
