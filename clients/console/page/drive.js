/**
 * Driving: reads the keys, the on-screen sticks and the gamepad every frame and sends the controls
 * when they change, at most 30 times a second, and again before the vehicle's lease ends.
 */

import { Refusal } from './api.js';
import { setText, words } from './format.js';
import { KIND, SPEED } from './world.js';

const LEAST_MS = 33;
const RENEW_MS = 180;
const STEP_MS = 16;
const LEVER_S = 1.5; // an aeroplane's throttle, from nothing to full
const GEARS = ['automatic', 'reverse', 'neutral', 'low'];
const clamp = (value, least, most) => Math.round(Math.min(Math.max(value, least), most) * 100) / 100;

/** Draws a bar from the middle to the right or to the left. */
function showLever(id, value) {
  const bar = document.getElementById(id);
  bar.style.left = `${50 + 50 * Math.min(value, 0)}%`;
  bar.style.width = `${50 * Math.abs(value)}%`;
}

export class Drive {
  /**
   * @param {import('./session.js').Session} session
   * @param {import('./world.js').World} world
   * @param {import('./keys.js').Keys} keys
   * @param {import('./hands.js').Hands} hands
   * @param {import('./gamepad.js').Pads} pads
   */
  constructor(session, world, keys, hands, pads) {
    Object.assign(this, { session, world, keys, hands, pads });
    this.strip = document.getElementById('driving');
    this.gear = GEARS[0];
    this.vehicle = 0;
    this.throttle = 0;
    this.busy = false;
    this.sent = '';
    this.sentAt = 0;
    this.last = performance.now();
    session.addEventListener('change', () => this.turn());
    document.getElementById('driving-show').addEventListener('click', () => session.select(session.driven));
    setInterval(() => this.step(), STEP_MS);
  }

  nextGear() {
    this.gear = GEARS[(GEARS.indexOf(this.gear) + 1) % GEARS.length];
    setText(document.getElementById('driving-gear'), words(this.gear));
  }

  turn() {
    const { driven, selected } = this.session;
    if (driven !== this.vehicle) {
      this.vehicle = driven;
      this.gear = GEARS[0];
      this.throttle = this.speedShare();
      this.sent = '';
      this.keys.rest();
      this.keys.driving = driven !== 0;
      this.hands.show(driven !== 0);
      setText(document.getElementById('driving-gear'), words(this.gear));
    }
    this.strip.classList.toggle('on', driven !== 0);
    document.getElementById('driving-levers').hidden = driven === 0;
    document.getElementById('driving-show').hidden = driven === 0 || driven === selected;
    setText(document.getElementById('driving-what'), driven ? 'you drive' : this.next());
    setText(document.getElementById('driving-name'), driven ? this.world.name(driven) : '');
    document.getElementById('driving-keys').hidden = driven === 0;
  }

  /** Returns what a visitor who drives nothing can do next. */
  next() {
    const { selected } = this.session;
    return selected ? `Next: press Take, or T, to drive ${this.world.name(selected)}.` :
      'Next: click a vehicle on the map or in the list.';
  }

  /** The kind of the vehicle. */
  kind() {
    return this.world.kind(this.world.now.get(this.vehicle)?.[KIND]);
  }

  /** Its speed as a share of its kind's greatest. */
  speedShare() {
    const speed = this.world.now.get(this.vehicle)?.[SPEED] ?? 0;
    return Math.min(speed / (this.kind().max_speed_mps || Infinity), 1);
  }

  /** The throttle of an aeroplane is a lever that stays, because without thrust it falls. */
  lever(pull, dt) {
    if (!(this.kind().min_speed_mps > 0)) return pull;
    this.throttle = Math.min(Math.max(this.throttle + pull * dt / LEVER_S, 0), 1);
    return this.throttle;
  }

  /** The present controls. */
  read(dt) {
    const all = [this.keys.step(dt), this.hands.levers, this.pads.step()].filter((levers) => levers);
    const sum = (lever) => all.reduce((total, levers) => total + levers[lever], 0);
    const flies = this.kind().domain === 'air';
    const rise = clamp(sum('rise'), -1, 1);
    return {
      throttle: clamp(this.lever(clamp(sum('throttle'), -1, 1), dt), -1, 1),
      steer: clamp(sum('steer'), -1, 1),
      climb: flies ? rise : 0,
      traverse: clamp(sum('traverse'), -1, 1),
      elevate: flies ? 0 : rise,
      brake: clamp(sum('brake'), 0, 1),
      gear: this.gear,
    };
  }

  step() {
    const now = performance.now();
    const dt = Math.min((now - this.last) / 1000, 0.1);
    this.last = now;
    if (!this.vehicle) return;
    const levers = this.read(dt);
    showLever('m-throttle', levers.throttle);
    showLever('m-steer', levers.steer);
    if (this.busy || this.session.taking) return;
    const text = JSON.stringify(levers), since = now - this.sentAt;
    if (since >= RENEW_MS || (text !== this.sent && since >= LEAST_MS)) this.send(levers, text);
  }

  async send(levers, text) {
    const { vehicle } = this;
    this.busy = true;
    this.sent = text;
    this.sentAt = performance.now();
    try {
      await this.session.order({ do: 'drive', vehicle, ...levers });
    } catch (error) {
      if (!(error instanceof Refusal)) throw error;
      const lasting = error.status >= 400 && error.status < 500 && error.status !== 429;
      if (lasting && vehicle === this.session.driven) {
        this.session.showError(error);
        this.session.lose();
      }
    } finally {
      this.busy = false;
    }
  }
}
