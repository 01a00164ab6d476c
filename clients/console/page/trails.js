/** The vehicles' trails: places of the last half minute, a second apart. */

import { ID, X, Z, STATE, STATE_WRECK, KIND } from './world.js';

const PLACES = 30;
const EVERY_S = 1;
const MOST = 1500;

export class Trails {
  /** @param {import('./world.js').World} world */
  constructor(world) {
    this.world = world;
    /** @type {Map<number, Float64Array>} x, z pairs, the newest first; NaN where there is none */
    this.of = new Map();
    this.noted = -Infinity;
    world.addEventListener('state', () => this.note());
    world.addEventListener('meet', () => this.of.clear());
  }

  note() {
    const { state, entities } = this.world;
    if (state.time_s < this.noted) this.of.clear();
    else if (state.time_s - this.noted < EVERY_S) return;
    this.noted = state.time_s;
    const next = new Map();
    for (const entity of entities) {
      if (next.size >= MOST) break;
      if (entity[STATE] === STATE_WRECK || this.world.kind(entity[KIND]).domain === 'munition') continue;
      const places = this.of.get(entity[ID]) ?? new Float64Array(2 * PLACES).fill(NaN);
      if (places[0] !== entity[X] || places[1] !== entity[Z]) {
        places.copyWithin(2, 0);
        places[0] = entity[X];
        places[1] = entity[Z];
      }
      next.set(entity[ID], places);
    }
    this.of = next;
  }

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {import('./camera.js').Camera} camera
   * @param {number} id
   * @param {number} x where it is shown now
   * @param {number} y
   */
  trace(context, camera, id, x, y) {
    const places = this.of.get(id);
    if (!places) return;
    context.moveTo(x, y);
    for (let i = 0; i < places.length && !Number.isNaN(places[i]); i += 2) {
      context.lineTo(camera.px(places[i]), camera.py(places[i + 1]));
    }
  }
}
