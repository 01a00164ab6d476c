/** The feed of events: the newest first, filtered by type; a click shows the place. */

import { number, setText, time, words } from './format.js';
import { KIND } from './world.js';

const SHOWN = 200;

const byId = (id) => document.getElementById(id);
const TYPES = ['fire', 'detonation', 'collision', 'crater', 'agent', 'contact_end', 'command', 'mission', 'input'];

export class Feed {
  /**
   * @param {import('./events.js').Events} events
   * @param {import('./world.js').World} world
   * @param {import('./session.js').Session} session
   * @param {import('./map.js').MapView} map
   */
  constructor(events, world, session, map) {
    Object.assign(this, { events, world, session, map });
    this.types = new Set(TYPES);
    this.rows = byId('feed-rows');
    this.missed = Object.assign(document.createElement('output'), { className: 'soft' });
    for (const type of TYPES) byId('feed-types').append(this.filter(type));
    byId('feed-types').append(Object.assign(document.createElement('span'), { className: 'push' }), this.missed);
    events.addEventListener('fresh', (event) => this.add(/** @type {CustomEvent} */ (event).detail));
    events.addEventListener('clear', () => this.fill());
  }

  filter(type) {
    const label = Object.assign(document.createElement('label'), { className: `check ${type}` });
    const box = Object.assign(document.createElement('input'), { type: 'checkbox', checked: true });
    box.addEventListener('change', () => {
      if (box.checked) this.types.add(type);
      else this.types.delete(type);
      this.fill();
    });
    label.append(box, document.createTextNode(words(type)));
    return label;
  }

  /** Rewrites the list after another choice of types. */
  fill() {
    this.rows.replaceChildren();
    this.add(this.events.all);
    this.note();
  }

  add(fresh) {
    const lines = fresh.filter((event) => this.types.has(event.type)).slice(-SHOWN).map((event) => this.line(event));
    this.rows.prepend(...lines.reverse());
    while (this.rows.children.length > SHOWN) this.rows.lastElementChild.remove();
    this.note();
  }

  note() {
    byId('feed-empty').hidden = this.rows.children.length > 0;
    setText(byId('feed-empty'), this.types.size ? 'No event of these kinds has happened yet.' : 'Choose a kind of event above.');
    setText(this.missed, this.events.missed ? `${number(this.events.missed)} events missed` : '');
  }

  line(event) {
    const line = document.createElement('li');
    const button = Object.assign(document.createElement('button'), { type: 'button', className: 'plain' });
    const part = (name, text) => Object.assign(document.createElement('span'), { className: name, textContent: text });
    button.append(part('when', time(event.time_s)), part(`what ${event.type}`, words(event.type)), part('text', event.text));
    button.addEventListener('click', () => this.show(event));
    line.append(button);
    return line;
  }

  show(event) {
    const here = (event.ids ?? []).map((id) => this.map.where(id)).find((place) => place);
    if (event.point) this.map.showEvent(event.point[0], event.point[1]);
    else if (here) this.map.showEvent(here.x, here.z);
    else this.session.notices.show('This event has no place on the map.', 'bad');
    const vehicle = (event.ids ?? []).find((id) => this.isVehicle(id));
    if (vehicle) this.session.select(vehicle);
  }

  isVehicle(id) {
    const entity = this.world.now.get(id);
    return entity !== undefined && this.world.kind(entity[KIND]).domain !== 'munition';
  }
}
