/** The panel of the selected vehicle: its description, its state and its buttons. */

import { Course } from './course.js';
import { number, setText, share, words } from './format.js';
import { ask } from './notices.js';
import { drawVehicle, drawWreck, FORCE_CLASS, formOf } from './symbols.js';

const byId = (id) => document.getElementById(id);

/** name, value from a state's `me`, and how serious the value is. */
const FIGURES = [
  ['speed', (me) => `${number(me.speed_mps * 3.6, 1)} km/h`],
  ['heading', (me) => `${number(me.heading_deg, 1)}°`],
  ['pitch', (me) => `${number(me.pitch_deg, 1)}°`],
  ['roll', (me) => `${number(me.roll_deg, 1)}°`],
  ['altitude', (me) => `${number(me.y, 1)} m`],
  ['above-ground', (me) => `${number(me.altitude_m, 1)} m`],
  ['rounds', (me) => (me.rounds_full ? `${number(me.rounds)} of ${number(me.rounds_full)}` : 'unarmed'),
    (me) => me.rounds_full > 0 && me.rounds / me.rounds_full],
  ['fuel', (me) => (me.fuel_full_l ? `${number(me.fuel_l)} l, ${share(me.fuel_l, me.fuel_full_l)}` : 'none needed'),
    (me) => me.fuel_full_l > 0 && me.fuel_l / me.fuel_full_l],
  ['damage', (me) => words(me.damage), (me) => ({ none: 1, low: 0.8, med: 0.4 })[me.damage] ?? 0],
  ['reload', (me) => (me.reload_s > 0 ? `${number(me.reload_s, 1)} s` : 'ready')],
  ['turret', (me) => `${number(me.turret_deg, 1)}°`],
  ['gun', (me) => `${number(me.gun_deg, 1)}°`],
  ['behaviour', (me) => words(me.behaviour)],
  ['throttle', (me) => (typeof me.throttle === 'number' ? share(me.throttle, 1) : '–')],
  ['gear', (me) => words(me.gear ?? '–')],
  ['target', (me, world) => (me.target ? world.name(me.target) : 'none')],
  ['x', (me) => `${number(me.x, 1)} m`],
  ['z', (me) => `${number(me.z, 1)} m`],
  ['latitude', (me) => me.degrees.split(',')[0]],
  ['longitude', (me) => me.degrees.split(',')[1]],
  ['MGRS', (me) => me.mgrs || 'none here'],
];

export class Vehicle {
  /**
   * @param {import('./world.js').World} world
   * @param {import('./session.js').Session} session
   * @param {import('./map.js').MapView} map
   */
  constructor(world, session, map) {
    Object.assign(this, { world, session, map });
    this.drawnAs = '';
    /** The vehicle whose statistics were asked for and were not in the previous state. */
    this.asked = 0;
    this.course = new Course(byId('v-course'));
    const list = byId('v-gauges');
    this.cells = FIGURES.map(([name]) => {
      const row = document.createElement('div');
      row.append(Object.assign(document.createElement('dt'), { textContent: words(name) }));
      const cell = Object.assign(document.createElement('dd'), { id: `s-${name}` });
      row.append(cell);
      list.append(row);
      return cell;
    });
    byId('v-take').addEventListener('click', () => this.toggle());
    byId('v-fire').addEventListener('click', () => session.fire());
    byId('v-remove').addEventListener('click', () => this.remove());
    byId('v-centre').addEventListener('click', () => {
      const at = map.where(session.selected);
      if (at) map.show(at.x, at.z);
    });
    world.addEventListener('state', () => this.show());
    session.addEventListener('change', () => this.select());
    this.select();
  }

  /** Takes the selected vehicle, or releases it if this page drives it. */
  async toggle() {
    const { session } = this;
    if (session.driven && session.driven === session.selected) await session.release();
    else await session.take(session.selected);
  }

  select() {
    const { selected, driven } = this.session;
    this.world.me = selected;
    setText(byId('v-take'), driven && driven === selected ? 'Release' : 'Take');
    const me = this.world.state?.me;
    if (!me || me.id !== selected) {
      setText(byId('v-name'), selected ? this.world.name(selected) : 'No vehicle');
      setText(byId('v-kind'), '');
      byId('v-gauges').hidden = byId('v-course').hidden = true;
      byId('v-empty').hidden = selected !== 0;
    }
    this.enable(Boolean(selected));
  }

  enable(there) {
    for (const id of ['v-centre', 'v-take', 'v-fire', 'v-fire-at', 'v-remove']) byId(id).disabled = !there;
  }

  show() {
    const { selected } = this.session;
    const me = this.world.state.me;
    if (!selected) return;
    if (!me || me.id !== selected) {
      const gone = this.asked === selected;
      this.asked = selected;
      if (!gone) return;
      setText(byId('v-empty'), 'This vehicle is no longer in the world. Choose another on the map or in the list.');
      byId('v-empty').hidden = false;
      byId('v-gauges').hidden = byId('v-course').hidden = true;
      this.enable(false);
      return;
    }
    this.asked = selected;
    byId('v-empty').hidden = true;
    byId('v-gauges').hidden = byId('v-course').hidden = false;
    this.enable(true);
    byId('v-take').disabled = me.state === 'wreck' || me.driver === 'another';
    setText(byId('v-name'), me.name || this.world.name(selected));
    setText(byId('v-kind'), `${words(me.force)} ${words(me.kind)} ${selected}${me.state === 'wreck' ? ', a wreck' : me.grounded ? ', on the ground' : me.pull_up ? ': PULL UP' : ''}`);
    byId('v-driver').hidden = !me.driver;
    setText(byId('v-driver'), !me.driver ? '' : me.driver === 'you' ? 'yours' : `${this.world.players.get(selected) ?? 'another client'} drives it`);
    FIGURES.forEach(([, text, left], i) => {
      setText(this.cells[i], text(me, this.world));
      const part = left ? left(me) : 1;
      const how = part === false || part > 0.5 ? '' : part > 0.2 ? 'low' : 'bad';
      if (this.cells[i].className !== how) this.cells[i].className = how;
    });
    this.drawSymbol(me);
    this.course.note(me, this.world.state.time_s);
  }

  drawSymbol(me) {
    const as = `${me.kind} ${me.force} ${me.state}`;
    if (as === this.drawnAs) return;
    this.drawnAs = as;
    const canvas = byId('v-symbol'), context = canvas.getContext('2d');
    const kind = this.world.info.kinds.find((one) => one.name === me.kind) ?? { name: '', domain: 'land' };
    context.clearRect(0, 0, canvas.width, canvas.height);
    if (me.state === 'wreck') drawWreck(context, 28, 28, 50);
    else drawVehicle(context, formOf(kind), 28, 30, 0, 36, Math.max(FORCE_CLASS.indexOf(me.force), 0), 0);
  }

  async remove() {
    const { selected } = this.session;
    const name = this.world.name(selected);
    if (!(await ask(`Remove ${name} from the world? This cannot be undone.`, 'Remove'))) return;
    const answer = await this.session.command({ do: 'remove', vehicle: selected });
    if (!answer) return;
    if (this.session.driven === selected) this.session.lose();
    this.session.select(0);
    this.session.notices.show(`${name} was removed in frame ${number(answer.frame)}.`);
  }
}
