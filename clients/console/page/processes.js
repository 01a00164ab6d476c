/** The table of the world's processes, with buttons that kill or restart them. */

import { Refusal } from './api.js';
import { number, setText, words } from './format.js';
import { ask } from './notices.js';

const EVERY_MS = 500;
/** Without these roles the world stops for a moment. */
const CENTRAL = ['mover', 'collider'];

const byId = (id) => document.getElementById(id);

export class Processes {
  /**
   * @param {import('./api.js').Api} api
   * @param {import('./session.js').Session} session
   */
  constructor(api, session) {
    Object.assign(this, { api, session });
    this.open = false;
    this.rows = byId('process-rows');
    setInterval(() => {
      if (this.open && !document.hidden) this.look();
    }, EVERY_MS);
  }

  async look() {
    try {
      const all = await this.api.get('processes');
      this.show(all);
    } catch (error) {
      if (!(error instanceof Refusal)) throw error;
      setText(byId('process-empty'), error.text);
      byId('process-empty').hidden = false;
    }
  }

  show(all) {
    const known = new Map([...this.rows.children].map((line) => [line.dataset.role, line]));
    for (const process of all) {
      const line = known.get(process.role) ?? this.line(process.role);
      known.delete(process.role);
      const texts = [process.role, words(process.state), process.pid ? String(process.pid) : '–', number(process.restarts),
        number(process.beat_age_ms), number(process.stage_ms, 2), number(process.late_frames)];
      texts.forEach((text, i) => setText(line.children[i], text));
      line.children[1].className = process.state === 'ready' ? 'good' : 'low';
    }
    for (const line of known.values()) line.remove();
    byId('process-empty').hidden = all.length > 0;
    setText(byId('process-empty'), 'No process of this world runs. Start it with jolon start.');
  }

  line(role) {
    const line = document.createElement('tr');
    line.dataset.role = role;
    for (let i = 0; i < 7; i++) {
      line.append(Object.assign(document.createElement('td'), { className: i > 1 ? 'n' : '' }));
    }
    const cell = Object.assign(document.createElement('td'), { className: 'changes buttons' });
    cell.append(this.button(role, 'restart', 'Restart', `Restart the ${role}`),
      this.button(role, 'kill', 'Kill', `Kill the ${role}`));
    line.append(cell);
    this.rows.append(line);
    return line;
  }

  button(role, action, text, label) {
    const button = Object.assign(document.createElement('button'), { type: 'button', textContent: text, ariaLabel: label });
    if (action === 'kill') button.className = 'hurts';
    button.addEventListener('click', () => this.act(role, action));
    return button;
  }

  async act(role, action) {
    const stands = CENTRAL.includes(role) ? ' The world stops for a moment; no frame is lost.' : '';
    if (action === 'kill' && !(await ask(`Kill the ${role}? The keeper starts it again.${stands}`, `Kill the ${role}`))) return;
    try {
      await this.api.post('process', { do: action, role });
      this.session.notices.show(action === 'kill' ? `The ${role} was killed.` : `The ${role} starts again.`);
    } catch (error) {
      this.session.showError(error);
    }
    this.look();
  }
}
