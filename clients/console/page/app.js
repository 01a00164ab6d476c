/** The page: makes its parts and connects them. */

import { Api } from './api.js';
import { Drive } from './drive.js';
import { Events } from './events.js';
import { Feed } from './feed.js';
import { number, setText, time, words } from './format.js';
import { Pads } from './gamepad.js';
import { listen } from './gestures.js';
import { Hands } from './hands.js';
import { Keys } from './keys.js';
import { List } from './list.js';
import { MapView } from './map.js';
import { Notices } from './notices.js';
import { Orders } from './orders.js';
import { Picture } from './picture.js';
import { Place } from './place.js';
import { Processes } from './processes.js';
import { Session } from './session.js';
import { tabs } from './tabs.js';
import { Tally } from './tally.js';
import { Trails } from './trails.js';
import { Vehicle } from './vehicle.js';
import { ID, KIND, STATE, STATE_WRECK, World } from './world.js';

const byId = (id) => document.getElementById(id);

const api = new Api();
const notices = new Notices(byId('notices'));
const world = new World(api);
const session = new Session(api, notices);
const events = new Events(api, world);
const map = new MapView(byId('map'), world, session, new Trails(world), events);
const picture = new Picture(api, session, byId('picture'));
const vehicle = new Vehicle(world, session, map);
const list = new List(world, session, map);
new Feed(events, world, session, map);
const processes = new Processes(api, session);
const tally = new Tally(world);
const orders = new Orders(world, session);
const place = new Place(api, map, orders, notices);

document.body.classList.toggle('spectator', !api.mayChange);
byId('spectator').hidden = api.mayChange;

/* --- the top bar ---------------------------------------------------------------------------- */

function mapNote(state) {
  if (state.left_out) return `${number(state.left_out)} more vehicles here; zoom in to see all`;
  return map.ground.missing ? 'The ground is being loaded.' : '';
}

/** Selects a vehicle for a new visitor: the first tank, or else the first vehicle, which in the
 * training world is the one to begin with. */
function lookAtSomething() {
  if (session.selected || !world.state) return;
  const there = world.entities.filter((entity) => entity[STATE] !== STATE_WRECK &&
    world.kind(entity[KIND]).domain !== 'munition');
  const tank = there.find((entity) => world.kind(entity[KIND]).name === 'tank');
  const one = (world.info.ground !== 'training' && tank) || there[0];
  world.removeEventListener('state', lookAtSomething);
  if (one) session.select(one[ID]);
}

world.addEventListener('meet', () => {
  session.reset();
  world.addEventListener('state', lookAtSomething);
});
world.addEventListener('meet', () => setText(byId('world-name'), `${world.info.world} · ${words(world.info.ground)}`));
world.addEventListener('state', () => {
  const { state } = world;
  setText(byId('g-time'), time(state.time_s));
  setText(byId('g-frame'), number(state.frame));
  setText(byId('g-rate'), `${number(state.rate_hz, 1)} Hz`);
  setText(byId('g-late'), number(state.late_frames));
  setText(byId('g-vehicles'), number(state.vehicles));
  if (!orders.tool) setText(byId('map-note'), mapNote(state));
});
const showState = () => {
  const text = world.trouble || words(world.state?.state ?? 'loading');
  setText(byId('world-state'), text);
  byId('world-state').className = `badge ${world.trouble ? 'bad' : world.state?.state === 'running' ? 'good' : 'low'}`;
};
world.addEventListener('state', showState);
world.addEventListener('trouble', showState);

byId('join').addEventListener('submit', async (event) => {
  event.preventDefault();
  const name = byId('join-name').value.trim();
  if (name && await session.join(name)) byId('picture').focus();
});
session.addEventListener('change', () => {
  byId('join').hidden = session.player !== '';
  byId('player').hidden = session.player === '';
  setText(byId('player'), session.player);
});

/* --- driving -------------------------------------------------------------------------------- */

const follow = (on) => {
  map.follow = on;
  byId('follow').setAttribute('aria-pressed', String(on));
  map.touch();
};
const gear = () => drive.nextGear();
const keys = new Keys({
  Space: () => session.fire(),
  KeyG: gear,
  KeyV: () => picture.next(),
  KeyC: () => follow(!map.follow),
  KeyT: () => vehicle.toggle(),
  Escape: () => orders.select(''),
});
const hands = new Hands(byId('picture'), byId('pad'), () => session.fire());
const pads = new Pads({ fire: () => session.fire(), gear, view: () => picture.next() });
const drive = new Drive(session, world, keys, hands, pads);

/* A button that a pointer pressed keeps the focus, and the space bar would press it again. */
document.addEventListener('click', (event) => {
  if (session.driven && event.detail > 0 && event.target.closest('button')) byId('picture').focus();
});

/* --- the map -------------------------------------------------------------------------------- */

const zoom = (factor) => {
  map.camera.zoom(factor);
  map.touch();
};
byId('zoom-in').addEventListener('click', () => zoom(1 / 1.6));
byId('zoom-out').addEventListener('click', () => zoom(1.6));
byId('zoom-all').addEventListener('click', () => {
  follow(false);
  map.camera.showAll(map.camera.side);
  map.touch();
});
byId('follow').addEventListener('click', () => follow(!map.follow));
byId('tracks').addEventListener('click', () => {
  map.showTracks = !map.showTracks;
  byId('tracks').setAttribute('aria-pressed', String(map.showTracks));
  map.touch();
});

listen(map, {
  click(px, py, again) {
    const near = map.nearest(px, py);
    if (orders.tool) orders.use(map.camera.worldX(px), map.camera.worldZ(py), near);
    else if (again && near) session.take(near);
    else session.select(near || session.driven);
    map.pin = null;
    map.touch();
  },
  hover(px, py) {
    const near = map.nearest(px, py);
    place.hover(near ? world.name(near) : '', map.camera.worldX(px), map.camera.worldZ(py));
    map.canvas.classList.toggle('over', near !== 0);
  },
  moved() {
    if (map.follow) follow(false);
  },
});

/* --- tables and dialogs ----------------------------------------------------------------------- */

tabs(document.querySelector('[role="tablist"]'), (panel) => {
  for (const [name, part] of Object.entries({ list, processes, tally })) {
    part.open = panel === name;
  }
  if (panel === 'list') list.look();
  if (panel === 'processes') processes.look();
});
byId('help-open').addEventListener('click', () => byId('help').showModal());

world.run();
events.run();
picture.run();
