/** The world's counters since its first frame, and its frame times. */

import { number, setText, words } from './format.js';

export class Tally {
  /** @param {import('./world.js').World} world */
  constructor(world) {
    this.world = world;
    this.open = false;
    this.list = document.getElementById('tally-figures');
    /** @type {Map<string, HTMLElement>} */
    this.cells = new Map();
    world.addEventListener('state', () => {
      if (this.open) this.show();
    });
  }

  show() {
    const { state } = this.world;
    for (const [name, value] of Object.entries(state.tally ?? {})) this.set(words(name), number(value));
    for (const [name, value] of Object.entries(state.frame_ms ?? {})) this.set(`frame ${name} [ms]`, number(value, 2));
    if (state.munitions !== undefined) this.set('munitions in flight', number(state.munitions));
    document.getElementById('tally-empty').hidden = this.cells.size > 0;
    setText(document.getElementById('tally-empty'), 'No counter is known yet.');
  }

  set(name, text) {
    let cell = this.cells.get(name);
    if (!cell) {
      const row = document.createElement('div');
      cell = document.createElement('dd');
      row.append(Object.assign(document.createElement('dt'), { textContent: name }), cell);
      this.list.append(row);
      this.cells.set(name, cell);
    }
    setText(cell, text);
  }
}
