/** Polls the world's events, newest last, for the feed and the map. */

import { Refusal } from './api.js';

const EVERY_MS = 400;
const HIDDEN_MS = 2000;
const KEPT = 1000;
const AT_ONCE = 250;

/**
 * @typedef {{sequence: number, frame: number, time_s: number, type: string, text: string,
 *   ids: number[], point: [number, number] | null}} WorldEvent
 */

export class Events extends EventTarget {
  /**
   * @param {import('./api.js').Api} api
   * @param {import('./world.js').World} world
   */
  constructor(api, world) {
    super();
    this.api = api;
    this.world = world;
    /** @type {WorldEvent[]} */
    this.all = [];
    this.next = 0;
    this.missed = 0;
    world.addEventListener('meet', () => this.clear());
  }

  clear() {
    this.all = [];
    this.next = 0;
    this.missed = 0;
    this.dispatchEvent(new Event('clear'));
  }

  /** Polls for ever. */
  async run() {
    for (;;) {
      try {
        if (this.world.state) await this.look();
      } catch (error) {
        if (!(error instanceof Refusal)) throw error;
      }
      await new Promise((resolve) => setTimeout(resolve, document.hidden ? HIDDEN_MS : EVERY_MS));
    }
  }

  async look() {
    const oldest = Math.max((this.world.state.events ?? 0) - KEPT, 0);
    if (this.next < oldest) {
      this.missed += this.next ? oldest - this.next : 0;
      this.next = oldest;
    }
    const answer = await this.api.get('events', { after: this.next, most: AT_ONCE });
    const fresh = answer.events.filter((event) => event.sequence >= this.next);
    for (const event of fresh) event.text = this.withNames(event);
    this.next = answer.next;
    this.missed += answer.missed ?? 0;
    if (fresh.length === 0) return;
    this.all.push(...fresh);
    if (this.all.length > KEPT) this.all.splice(0, this.all.length - KEPT);
    this.dispatchEvent(new CustomEvent('fresh', { detail: fresh }));
  }

  /** An event's text with the names of vehicles that have one: "Padre fired at ...". */
  withNames(event) {
    const before = event.type === 'command' ? '' : '[\\w-]+ ';
    return (event.ids ?? []).reduce((text, id) => {
      const name = this.world.info.names?.[id];
      return name ? text.replace(new RegExp(`(?<=^| )${before}${id}(?= |$|:|,)`), name) : text;
    }, event.text);
  }
}
