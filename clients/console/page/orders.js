/** Commands to the world: time, spawning, fire missions, fire at a target. */

import { number, setText, words } from './format.js';

/** The behaviours that a new vehicle can be given; agents choose the others themselves. */
const FIRST_ORDERS = ['idle', 'hold', 'patrol'];

const byId = (id) => document.getElementById(id);

export class Orders {
  /**
   * @param {import('./world.js').World} world
   * @param {import('./session.js').Session} session
   */
  constructor(world, session) {
    Object.assign(this, { world, session });
    /** The tool of a click on the map: '', 'spawn', 'mission' or 'target'. */
    this.tool = '';
    byId('pause').addEventListener('click', () => this.pause());
    byId('step').addEventListener('click', () => session.command({ do: 'step', frames: 1 }));
    byId('scale').addEventListener('change', () =>
      session.command({ do: 'scale', scale: Number(byId('scale').value) }));
    for (const button of document.querySelectorAll('[data-tool]')) {
      button.addEventListener('click', () => this.select(button.dataset.tool));
    }
    byId('v-fire-at').addEventListener('click', () => this.select('target'));
    for (const form of ['spawn-form', 'mission-form']) {
      byId(form).addEventListener('submit', (event) => event.preventDefault());
      byId(form).querySelector('[data-done]').addEventListener('click', () => this.select(''));
    }
    world.addEventListener('meet', () => this.meet());
    world.addEventListener('state', () => this.show());
  }

  meet() {
    const { kinds, forces } = this.world.info;
    const fill = (id, names, chosen) => byId(id).replaceChildren(
      ...names.map((name) => new Option(words(name), name, name === chosen, name === chosen)));
    const named = (domains) => kinds.filter((kind) => domains.includes(kind.domain)).map((kind) => kind.name);
    fill('spawn-kind', named(['land', 'sea', 'air']), 'tank');
    fill('spawn-force', forces, 'blue');
    fill('spawn-behaviour', FIRST_ORDERS, 'idle');
    fill('mission-munition', named(['munition']), 'artillery');
  }

  get paused() {
    return this.world.state?.state === 'paused' || this.world.state?.paused === true;
  }

  pause() {
    return this.session.command({ do: this.paused ? 'resume' : 'pause' });
  }

  show() {
    setText(byId('pause'), this.paused ? 'Resume' : 'Pause');
    byId('step').disabled = !this.paused;
    const scale = String(this.world.state.scale ?? 1), choice = byId('scale');
    if (document.activeElement === choice || choice.value === scale) return;
    if (![...choice.options].some((option) => option.value === scale)) {
      choice.append(new Option(`${scale}×`, scale));
    }
    choice.value = scale;
  }

  /** Selects a tool, or deselects it if it is selected. */
  select(tool) {
    this.tool = tool === this.tool ? '' : tool;
    for (const button of document.querySelectorAll('[data-tool]')) {
      button.setAttribute('aria-pressed', String(button.dataset.tool === this.tool));
    }
    byId('v-fire-at').setAttribute('aria-pressed', String(this.tool === 'target'));
    byId('spawn-form').hidden = this.tool !== 'spawn';
    byId('mission-form').hidden = this.tool !== 'mission';
    byId('map').classList.toggle('aims', this.tool !== '');
    setText(byId('map-note'), this.tool === 'target' ? 'Click the vehicle to fire at. Esc cancels.' : '');
  }

  /**
   * Handles a click on the map with a tool.
   * @param {number} x [m]
   * @param {number} z [m]
   * @param {number} near the vehicle there, 0: none
   */
  async use(x, z, near) {
    if (this.tool === 'spawn') await this.spawn(x, z);
    else if (this.tool === 'mission') await this.mission(x, z);
    else if (near) {
      this.select('');
      await this.session.fire(near);
    }
  }

  async spawn(x, z) {
    const kind = byId('spawn-kind').value;
    const answer = await this.session.command({
      do: 'spawn', kind, force: byId('spawn-force').value, behaviour: byId('spawn-behaviour').value,
      x, z, heading_deg: 0,
    });
    if (!answer) return;
    this.session.select(answer.entity);
    this.session.notices.show(`A ${words(kind)}, number ${answer.entity}, was added in frame ${number(answer.frame)}.`);
  }

  async mission(x, z) {
    const rounds = Number(byId('mission-rounds').value);
    const answer = await this.session.command({
      do: 'mission', munition: byId('mission-munition').value, rounds, x, z,
      every_s: Number(byId('mission-every').value), radius_m: Number(byId('mission-radius').value),
    });
    if (answer) this.session.notices.show(`${number(rounds)} rounds were ordered.`);
  }
}
