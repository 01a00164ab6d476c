/**
 * The live picture: requests a newer picture than the last, decodes it and only then draws it on
 * the canvas, so that nothing flickers. While the renderer is absent it says so and tries again.
 */

import { Refusal } from './api.js';

const AGAIN_MS = 700;
const IDLE_MS = 250;
/** A few fixed sizes, so that viewers of the same vehicle share a picture. */
const SIZES = [[480, 270], [640, 360], [960, 540], [1280, 720]];

export class Picture {
  /**
   * @param {import('./api.js').Api} api
   * @param {import('./session.js').Session} session
   * @param {HTMLElement} place
   */
  constructor(api, session, place) {
    this.api = api;
    this.session = session;
    this.place = place;
    this.canvas = /** @type {HTMLCanvasElement} */ (place.querySelector('canvas'));
    this.context = this.canvas.getContext('2d', { alpha: false });
    this.note = place.querySelector('.note');
    this.view = 'chase';
    this.newest = 0;
    this.shown = 0;
    this.stop = new AbortController();
    for (const button of place.querySelectorAll('[data-view]')) {
      button.addEventListener('click', () => this.select(button.dataset.view));
    }
    session.addEventListener('change', () => this.turn());
  }

  /** @param {string} view */
  select(view) {
    this.view = view;
    for (const button of this.place.querySelectorAll('[data-view]')) {
      button.setAttribute('aria-pressed', String(button.dataset.view === view));
    }
    this.turn();
  }

  next() {
    const views = [...this.place.querySelectorAll('[data-view]')].map((button) => button.dataset.view);
    this.select(views[(views.indexOf(this.view) + 1) % views.length]);
  }

  /** Called when another view is wanted: does not wait for a picture of the previous one. */
  turn() {
    const subject = `${this.session.selected} ${this.view}`;
    if (subject === this.subject) return;
    this.subject = subject;
    this.newest = 0;
    this.stop.abort();
    this.stop = new AbortController();
  }

  /** Requests pictures for ever. */
  async run() {
    for (;;) {
      const { selected } = this.session;
      if (!selected || document.hidden) {
        if (!selected) this.showText('Choose a vehicle on the map or in the list.');
        await new Promise((resolve) => setTimeout(resolve, IDLE_MS));
        continue;
      }
      try {
        await this.look(selected);
      } catch (error) {
        if (!(error instanceof Refusal) && error.name !== 'AbortError') throw error;
        if (error instanceof Refusal) await this.wait(error);
      }
    }
  }

  async look(vehicle) {
    const box = this.place.getBoundingClientRect();
    const [w, h] = SIZES.find(([width]) => width >= box.width - 60) ?? SIZES.at(-1);
    const after = this.newest ? `&after=${this.newest}` : '';
    const { signal } = this.stop;
    const path = `/api/picture?view=${this.view}&vehicle=${vehicle}&size=${w}x${h}&bar=0${after}`;
    const response = await this.api.fetch(path, { signal });
    const bitmap = await createImageBitmap(await response.blob());
    if (!signal.aborted) {
      this.newest = Number(response.headers.get('X-Picture')) || 0;
      if (this.canvas.width !== bitmap.width || this.canvas.height !== bitmap.height) {
        this.canvas.width = bitmap.width;
        this.canvas.height = bitmap.height;
      }
      this.context.drawImage(bitmap, 0, 0);
      this.shown++;
      this.place.dataset.pictures = String(this.shown);
      this.showText('');
    }
    bitmap.close();
    if (!this.newest) await new Promise((resolve) => setTimeout(resolve, IDLE_MS));
  }

  /** @param {Refusal} refusal */
  async wait(refusal) {
    const away = refusal.status === 503 || refusal.status === 502 || refusal.status === 0;
    this.showText(away && !/different pictures/.test(refusal.message) ?
      'The renderer does not answer. The page tries again.' : refusal.text);
    this.newest = 0;
    await new Promise((resolve) => setTimeout(resolve, AGAIN_MS));
  }

  showText(text) {
    if (this.note.textContent === text) return;
    this.note.textContent = text;
    this.note.hidden = text === '';
    this.place.classList.toggle('stale', text !== '');
  }
}
