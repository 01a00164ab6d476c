/**
 * The world as the page knows it: its description, read once, its state, read ten times a second,
 * and the places of the entities between two states.
 */

import { Refusal } from './api.js';
import { entityAt, ROW } from './motion.js';

/**
 * A vehicle or munition of a state, as the server sends it.
 * @typedef {[id: number, kind: number, force: number, behaviour: number, state: number, damage: number,
 *   x: number, z: number, heading: number, speed: number, turret: number, driven: number]} Entity
 */
export const ID = 0, KIND = 1, FORCE = 2, STATE = 4, X = 6, Z = 7, HEADING = 8, SPEED = 9, TURRET = 10, DRIVEN = 11;
export const STATE_WRECK = 2;
export const DRIVEN_BY_ANOTHER = 1;

const EVERY_MS = 100;
const HIDDEN_MS = 1000;
const AGAIN_MS = 1000;
const MOST = 5000;
const WHOLE_MS = 5000;

export class World extends EventTarget {
  /** @param {import('./api.js').Api} api */
  constructor(api) {
    super();
    this.api = api;
    /** @type {any} what /api/world says; null until it is known */
    this.info = null;
    /** @type {any} the newest state; null until there is one */
    this.state = null;
    /** @type {Entity[]} */
    this.entities = [];
    /** @type {Map<number, Entity>} by id, of the newest state */
    this.now = new Map();
    /** @type {Map<number, Entity>} and of the one before it */
    this.before = new Map();
    /** @type {Map<number, string>} who drives a vehicle, by its id */
    this.players = new Map();
    /** @type {Map<number, number[]>} what the server has told of each row, as motion.js reads it */
    this.told = new Map();
    this.stride = 0;
    this.toldArea = '';
    this.wholeAt = 0;
    this.arrived = 0;
    this.gap = EVERY_MS;
    /** @type {string} what is wrong with the connection, '' for nothing */
    this.trouble = '';
    /** The query: the visible part of the map, and the vehicle whose statistics are wanted. */
    this.area = [0, 0, 1e6, 1e6];
    this.me = 0;
  }

  /** Polls for ever. */
  async run() {
    for (;;) {
      const began = performance.now();
      let pause = document.hidden ? HIDDEN_MS : EVERY_MS;
      try {
        if (!this.info || this.trouble) await this.meet();
        await this.look();
        this.setTrouble('');
      } catch (error) {
        if (!(error instanceof Refusal)) throw error;
        this.setTrouble(error.text);
        pause = AGAIN_MS;
      }
      const spent = performance.now() - began;
      await new Promise((resolve) => setTimeout(resolve, Math.max(pause - spent, spent / 2, 5)));
    }
  }

  /** Reads the world's description. For another run than before, everything is reset. */
  async meet() {
    const info = await this.api.get('world');
    const known = this.info?.run === info.run;
    this.info = info;
    if (known) return;
    this.state = null;
    this.now.clear();
    this.before.clear();
    this.dispatchEvent(new Event('meet'));
  }

  async look() {
    const area = this.area.map(Math.round).join(',');
    const anew = area !== this.toldArea || performance.now() - this.wholeAt > WHOLE_MS;
    const query = { area, most: MOST, since: this.state?.frame ?? 0, stride: anew ? 0 : this.stride };
    if (this.me) query.me = this.me;
    const state = await this.api.get('state', query);
    if (this.state && state.frame < this.state.frame) await this.meet();
    const arrived = performance.now();
    if (state.whole) this.wholeAt = arrived;
    this.toldArea = area;
    this.hear(state);
    const same = this.state !== null && state.frame === this.state.frame;
    if (!same || this.before.size === 0) {
      if (this.arrived) this.gap += 0.3 * (Math.min(arrived - this.arrived, 1000) - this.gap);
      this.before = this.now;
      this.arrived = arrived;
    } else {
      this.before = new Map();
    }
    this.state = state;
    this.entities = state.entities;
    this.now = new Map(state.entities.map((entity) => [entity[ID], entity]));
    this.players = new Map((state.players ?? []).map((player) => [player.vehicle, player.name]));
    this.dispatchEvent(new Event('state'));
  }

  /** Notes what a state tells, and writes where all entities are into it. */
  hear(state) {
    if (state.whole) this.told.clear();
    for (const row of state.gone ?? []) this.told.delete(row);
    for (const entity of state.entities) this.told.set(entity[ROW], entity);
    this.stride = state.stride;
    state.entities = [...this.told.values()].map((told) => entityAt(told, state.time_s));
  }

  /** The present moment's place between the last two states, 0 to 1 and a little beyond. */
  progress() {
    return Math.min((performance.now() - this.arrived) / Math.max(this.gap, 1), 1.2);
  }

  /**
   * The place where an entity is shown.
   * @param {Entity} entity of the newest state
   * @param {number} progress
   * @param {{x: number, z: number, heading: number}} place is filled
   */
  place(entity, progress, place) {
    const old = this.before.get(entity[ID]);
    place.x = entity[X];
    place.z = entity[Z];
    place.heading = entity[HEADING];
    if (!old) return;
    let turn = entity[HEADING] - old[HEADING];
    if (turn > Math.PI) turn -= 2 * Math.PI;
    if (turn < -Math.PI) turn += 2 * Math.PI;
    place.x = old[X] + (entity[X] - old[X]) * progress;
    place.z = old[Z] + (entity[Z] - old[Z]) * progress;
    place.heading = old[HEADING] + turn * progress;
  }

  /** @param {number} kind @returns {{name: string, domain: string, length_m: number}} */
  kind(kind) {
    return this.info?.kinds[kind] ?? { name: 'unknown', domain: 'land', length_m: 5 };
  }

  /** @param {number} id @returns {string} its name or marking, or its kind and number */
  name(id) {
    const given = this.info?.names?.[id] || this.state?.markings?.[id];
    if (given) return given;
    const entity = this.now.get(id);
    return entity ? `${this.kind(entity[KIND]).name} ${id}` : `number ${id}`;
  }

  setTrouble(trouble) {
    if (trouble === this.trouble) return;
    this.trouble = trouble;
    this.dispatchEvent(new Event('trouble'));
  }
}
