/** The table of vehicles: searched, filtered and sorted by the server, a page at a time. */

import { Refusal } from './api.js';
import { number, setText, words } from './format.js';
import { FORCE_CLASS } from './symbols.js';

const PAGE = 100;
const EVERY_MS = 1000;
const TYPING_MS = 150;

/** key of a row, title, sort key ('' for none), numeric, text */
const COLUMNS = [
  ['name', 'name', 'name', false, (row) => row.name || `${row.kind} ${row.id}`],
  ['id', 'number', 'id', true, (row) => String(row.id)],
  ['force', 'force', '', false, (row) => words(row.force)],
  ['kind', 'kind', 'kind', false, (row) => words(row.kind)],
  ['behaviour', 'behaviour', 'behaviour', false, (row) => (row.state === 'wreck' ? 'wreck' : words(row.behaviour))],
  ['speed', 'km/h', 'speed', true, (row) => number(row.speed_mps * 3.6, 1)],
  ['damage', 'damage', 'damage', false, (row) => words(row.damage)],
  ['rounds', 'rounds', 'rounds', true, (row) => number(row.rounds)],
  ['fuel', 'fuel [l]', 'fuel', true, (row) => number(row.fuel_l)],
];

const byId = (id) => document.getElementById(id);

export class List {
  /**
   * @param {import('./world.js').World} world
   * @param {import('./session.js').Session} session
   * @param {import('./map.js').MapView} map
   */
  constructor(world, session, map) {
    Object.assign(this, { world, session, map });
    this.sort = 'name';
    this.descending = false;
    this.from = 0;
    this.open = true;
    this.asked = 0;
    this.rows = byId('list-rows');
    this.head();
    const again = () => {
      this.from = 0;
      this.look();
    };
    let typing = 0;
    byId('list-search').addEventListener('input', () => {
      clearTimeout(typing);
      typing = setTimeout(again, TYPING_MS);
    });
    byId('list-force').addEventListener('change', again);
    byId('list-kind').addEventListener('change', again);
    byId('list-before').addEventListener('click', () => this.turn(-PAGE));
    byId('list-after').addEventListener('click', () => this.turn(PAGE));
    world.addEventListener('meet', () => this.meet());
    session.addEventListener('change', () => this.mark());
    setInterval(() => {
      if (this.open && !document.hidden) this.look();
    }, EVERY_MS);
  }

  head() {
    for (const [, title, sort, numeric] of COLUMNS) {
      const cell = document.createElement('th');
      if (numeric) cell.className = 'n';
      if (sort) {
        const button = Object.assign(document.createElement('button'), { type: 'button', textContent: title });
        button.addEventListener('click', () => this.order(sort));
        cell.dataset.sort = sort;
        cell.append(button);
      } else {
        cell.textContent = title;
      }
      byId('list-head').append(cell);
    }
    this.showOrder();
  }

  order(sort) {
    this.descending = this.sort === sort && !this.descending;
    this.sort = sort;
    this.from = 0;
    this.showOrder();
    this.look();
  }

  showOrder() {
    for (const cell of byId('list-head').children) {
      if (cell.dataset.sort === this.sort) cell.ariaSort = this.descending ? 'descending' : 'ascending';
      else cell.ariaSort = null;
    }
  }

  turn(by) {
    this.from = Math.max(this.from + by, 0);
    byId('list').querySelector('.scroll').scrollTop = 0;
    this.look();
  }

  meet() {
    const fill = (id, all, values) => byId(id).replaceChildren(new Option(all, ''),
      ...values.map((value) => new Option(words(value), value)));
    fill('list-force', 'all forces', this.world.info.forces);
    fill('list-kind', 'all kinds', this.world.info.kinds.filter((kind) => kind.domain !== 'munition' && kind.domain !== 'fixed')
      .map((kind) => kind.name));
    this.from = 0;
    this.look();
  }

  async look() {
    const asked = ++this.asked;
    try {
      const query = {
        search: byId('list-search').value.trim(), force: byId('list-force').value, kind: byId('list-kind').value,
        sort: this.sort, descending: this.descending ? 1 : '', from: this.from, most: PAGE,
      };
      const { total, rows } = await this.world.api.get('list', query);
      if (asked === this.asked) this.show(total, rows);
    } catch (error) {
      if (!(error instanceof Refusal)) throw error;
      if (asked === this.asked) setText(byId('list-count'), 'no answer');
    }
  }

  show(total, rows) {
    if (rows.length === 0 && total > 0) {
      this.turn(-this.from);
      return;
    }
    while (this.rows.children.length > rows.length) this.rows.lastElementChild.remove();
    while (this.rows.children.length < rows.length) this.rows.append(this.line());
    rows.forEach((row, i) => this.fill(this.rows.children[i], row));
    this.mark();
    byId('list-empty').hidden = total > 0;
    setText(byId('list-empty'), 'No vehicle matches. Search for a part of a name or a number.');
    setText(byId('list-count'), total ? `${number(this.from + 1)}–${number(this.from + rows.length)} of ${number(total)}` : 'none');
    byId('list-before').disabled = this.from === 0;
    byId('list-after').disabled = this.from + rows.length >= total;
  }

  line() {
    const line = document.createElement('tr');
    for (const [, , , numeric] of COLUMNS) {
      const cell = document.createElement('td');
      if (numeric) cell.className = 'n';
      line.append(cell);
    }
    const button = Object.assign(document.createElement('button'), { type: 'button', className: 'plain' });
    line.firstElementChild.append(button);
    line.addEventListener('click', () => this.pick(line));
    line.addEventListener('dblclick', () => this.session.take(Number(line.dataset.id)));
    return line;
  }

  pick(line) {
    this.session.select(Number(line.dataset.id));
    this.map.show(Number(line.dataset.x), Number(line.dataset.z));
  }

  fill(line, row) {
    Object.assign(line.dataset, { id: row.id, x: row.x, z: row.z });
    COLUMNS.forEach(([key, , , , text], i) => {
      const cell = line.children[i];
      setText(i === 0 ? cell.firstElementChild : cell, text(row));
      if (key === 'force') cell.className = FORCE_CLASS.includes(row.force) ? `force ${row.force}` : 'force';
    });
  }

  mark() {
    for (const line of this.rows.children) {
      const is = Number(line.dataset.id) === this.session.selected;
      line.classList.toggle('chosen', is);
    }
  }
}
