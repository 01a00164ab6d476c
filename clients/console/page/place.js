/** The field for a place: metres, latitude and longitude, or MGRS; and the place under the pointer. */

import { number, setText } from './format.js';

const REST_MS = 150; /* the pointer rests before its place on the earth is asked for */

const byId = (id) => document.getElementById(id);

export class Place {
  /**
   * @param {import('./api.js').Api} api
   * @param {import('./map.js').MapView} map
   * @param {import('./orders.js').Orders} orders
   * @param {import('./notices.js').Notices} notices
   */
  constructor(api, map, orders, notices) {
    Object.assign(this, { api, map, orders, notices });
    this.timer = 0;
    byId('place-form').addEventListener('submit', (event) => {
      event.preventDefault();
      this.go(byId('place').value.trim());
    });
  }

  /** Shows a place on the map, and uses the tool there if one is selected. */
  async go(text) {
    if (!text) return;
    const place = await this.api.get('place', { at: text }).catch((refusal) => {
      this.notices.show(refusal.text, 'bad');
      return null;
    });
    if (!place) return;
    this.map.showEvent(place.x, place.z);
    if (this.orders.tool === 'spawn' || this.orders.tool === 'mission') {
      await this.orders.use(place.x, place.z, 0);
    }
  }

  /**
   * Names the place under the pointer: metres at once, degrees and MGRS when the pointer rests.
   * @param {string} name of the vehicle there, '': none
   * @param {number} x [m]
   * @param {number} z [m]
   */
  hover(name, x, z) {
    const near = name ? `${name} · ` : '';
    const metres = `${near}x ${number(x)}  z ${number(z)} m`;
    setText(byId('map-where'), metres);
    clearTimeout(this.timer);
    this.timer = setTimeout(async () => {
      const timer = this.timer;
      const place = await this.api.get('place', { at: `${x.toFixed(1)},${z.toFixed(1)}` }).catch(() => null);
      if (place && timer === this.timer) setText(byId('map-where'), `${metres} · ${place.degrees} · ${place.mgrs}`);
    }, REST_MS);
  }
}
