/**
 * The user's session: the selected vehicle, the driven vehicle, and the right to send commands.
 * Dispatches 'change' when one of them changes.
 */

import { Refusal } from './api.js';

export class Session extends EventTarget {
  /**
   * @param {import('./api.js').Api} api
   * @param {import('./notices.js').Notices} notices
   */
  constructor(api, notices) {
    super();
    this.api = api;
    this.notices = notices;
    /** The selected vehicle, whose picture and statistics are shown; 0: none. */
    this.selected = 0;
    /** The vehicle that this page drives; 0: none. */
    this.driven = 0;
    /** Whether the page waits for the answer to its wish to drive another vehicle. */
    this.taking = false;
    /** Settled when the last drive has its answer. */
    this.lastDrive = Promise.resolve();
    /** The name of the player; '' until joined. */
    this.player = '';
  }

  get mayChange() {
    return this.api.mayChange;
  }

  changed() {
    this.dispatchEvent(new Event('change'));
  }

  select(id) {
    if (id === this.selected) return;
    this.selected = id;
    this.changed();
  }

  /** @param {string} name @returns {Promise<boolean>} whether there is a player now */
  async join(name) {
    try {
      this.api.key = '';
      const answer = await this.api.post('join', { name });
      this.api.key = answer.key;
      this.player = answer.name ?? name;
      this.changed();
      return true;
    } catch (error) {
      this.showError(error);
      return false;
    }
  }

  /**
   * Sends a command and shows a notice if it is refused.
   * @param {object} body of /api/command
   * @returns {Promise<any>} the answer; null when it was refused
   */
  async command(body) {
    try {
      if (!this.player && !(await this.join('player'))) return null;
      return await this.order(body);
    } catch (error) {
      this.showError(error);
      return null;
    }
  }

  /**
   * Sends a command without a notice. A drive waits until the one before has its answer: the server carries
   * out the last one that it hears, and two that are under way together may overtake each other.
   * @param {object} body of /api/command
   * @returns {Promise<any>} the answer
   * @throws {Refusal}
   */
  order(body) {
    if (body.do !== 'drive') return this.send(body);
    const answer = this.lastDrive.then(() => this.send(body));
    this.lastDrive = answer.catch(() => {});
    return answer;
  }

  /**
   * Sends a command at once. A player whom the server has forgotten joins again under the same name.
   * @param {object} body of /api/command
   * @throws {Refusal}
   */
  async send(body) {
    try {
      return await this.api.post('command', body);
    } catch (error) {
      const forgotten = error instanceof Refusal && error.status === 401 && this.api.key !== '';
      if (!forgotten || !(await this.join(this.player))) throw error;
      return this.api.post('command', body);
    }
  }

  /** Takes a vehicle; the server then releases the previous one. */
  async take(id) {
    if (!this.mayChange || !id || id === this.driven || this.taking) return;
    this.taking = true;
    const answer = await this.command({ do: 'drive', vehicle: id, throttle: 0, steer: 0 })
      .finally(() => { this.taking = false; });
    if (!answer) return;
    this.driven = id;
    this.selected = id;
    this.changed();
  }

  /** Releases the driven vehicle to its agent. */
  async release() {
    const left = this.driven;
    if (!left) return;
    this.lose();
    await this.command({ do: 'release', vehicle: left });
  }

  /** Forgets the vehicles when another world has begun. */
  reset() {
    this.driven = 0;
    this.selected = 0;
    this.changed();
  }

  /** Called when the driven vehicle is lost. */
  lose() {
    this.driven = 0;
    this.changed();
  }

  /** @param {number} [target] 0: where the gun points */
  async fire(target = 0) {
    const vehicle = this.driven || this.selected;
    if (!this.mayChange || !vehicle) return;
    await this.command(target ? { do: 'fire', vehicle, target } : { do: 'fire', vehicle });
  }

  /** Shows the text of a refusal. */
  showError(error) {
    if (!(error instanceof Refusal)) throw error;
    this.notices.show(error.text, 'bad');
  }
}
