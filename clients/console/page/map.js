/** The map: ground, grid, trails, vehicles, shots and the selection. It draws only on a change. */

import { Camera } from './camera.js';
import { drawGrid, drawLabel, drawScaleBar } from './grid.js';
import { Ground } from './ground.js';
import { drawBlast, drawMunition, drawVehicle, drawWreck, FILL, formOf } from './symbols.js';
import { DRIVEN, DRIVEN_BY_ANOTHER, FORCE, HEADING, ID, KIND, STATE, STATE_WRECK, TURRET, X, Z } from './world.js';

const FRAME_MS = 1000 / 30;
const SLOW_FRAME_MS = 100;
const FAST_MPS = 25; /* a vehicle of this speed should move at least a pixel a frame */
const SYMBOLS_MOST = 1200;
const SYMBOL_PX = 13;
const FORMS_BELOW_MPP = 60; /* [m] a pixel; at a coarser scale a symbol is a dot */
const BLAST_MS = 2500;
const NEAR_PX = 22;
const OBJECTIVE_NAMED_PX = 40; /* a narrower objective has no name */

export class MapView {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {import('./world.js').World} world
   * @param {import('./session.js').Session} session
   * @param {import('./trails.js').Trails} trails
   * @param {import('./events.js').Events} events
   */
  constructor(canvas, world, session, trails, events) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d', { alpha: false });
    this.world = world;
    this.session = session;
    this.trails = trails;
    this.camera = new Camera();
    this.ground = new Ground(world.api, () => this.touch());
    this.follow = false;
    this.showTracks = true;
    /** @type {{x: number, z: number, at: number, large: boolean}[]} */
    this.blasts = [];
    /** @type {{x: number, z: number} | null} the place of the event that is shown */
    this.pin = null;
    this.density = 1;
    this.dirty = true;
    /** Until the first state the map shows the whole world. */
    this.first = true;
    /** There are so many vehicles that they are dots; the user is moving the map. */
    this.crowd = false;
    this.held = false;
    this.drawn = 0;
    this.calm = matchMedia('(prefers-reduced-motion: reduce)');
    new ResizeObserver(() => this.resize()).observe(canvas);
    world.addEventListener('state', () => {
      if (this.first) this.frame();
      this.touch();
    });
    world.addEventListener('meet', () => this.meet());
    session.addEventListener('change', () => this.touch());
    events.addEventListener('fresh', (event) => this.note(/** @type {CustomEvent} */ (event).detail));
    requestAnimationFrame(() => this.tick());
  }

  meet() {
    this.camera.showAll(this.world.info.side_m);
    this.ground.clear();
    this.blasts = [];
    this.pin = null;
    this.first = true;
    this.touch();
  }

  /** Centres the map where most of the vehicles are. */
  frame() {
    const { camera, world } = this;
    if (world.entities.length === 0 || camera.width < 2) return;
    this.first = false;
    const inner = (column) => {
      const all = world.entities.map((entity) => entity[column]).sort((a, b) => a - b);
      const low = all[Math.floor(all.length * 0.1)], high = all[Math.floor((all.length - 1) * 0.9)];
      return [(low + high) / 2, high - low];
    };
    const [x, width] = inner(X), [z, height] = inner(Z);
    const wanted = Math.max((1.5 * width) / camera.width, (1.8 * height) / camera.height, 1);
    camera.zoom(wanted / camera.scale);
    camera.centre(x, z);
  }

  resize() {
    const box = this.canvas.getBoundingClientRect();
    this.density = Math.min(devicePixelRatio || 1, 2);
    this.canvas.width = Math.max(Math.round(box.width * this.density), 1);
    this.canvas.height = Math.max(Math.round(box.height * this.density), 1);
    const whole = this.camera.scale >= this.camera.widest() * 0.999;
    this.camera.resize(box.width, box.height);
    if (whole) this.camera.showAll(this.camera.side);
    this.draw();
  }

  /** Draws with the next frame. */
  touch() {
    this.dirty = true;
    this.world.area = this.camera.area(40);
  }

  note(fresh) {
    const at = performance.now();
    for (const event of fresh) {
      if (!event.point || !['fire', 'detonation', 'collision'].includes(event.type)) continue;
      const large = event.type === 'detonation';
      this.blasts.push({ x: event.point[0], z: event.point[1], at, large });
    }
    if (this.blasts.length > 300) this.blasts.splice(0, this.blasts.length - 300);
    this.touch();
  }

  tick() {
    requestAnimationFrame(() => this.tick());
    const now = performance.now();
    const moving = !this.calm.matches && this.world.progress() < 1.2 && this.world.before.size > 0;
    if (!(this.dirty || moving || this.blasts.length) || now - this.drawn < this.pause() - 2) return;
    this.draw();
  }

  /** [ms] between two drawings, as many as can be seen. */
  pause() {
    if (this.held) return FRAME_MS;
    if (this.crowd) return SLOW_FRAME_MS;
    return Math.min(Math.max((1000 * this.camera.scale) / FAST_MPS, FRAME_MS), SLOW_FRAME_MS);
  }

  progress() {
    return this.calm.matches ? 1 : this.world.progress();
  }

  /** The entity of the selected vehicle with its place on the map, or null. */
  shown(id) {
    const entity = this.world.now.get(id);
    if (!entity) return null;
    const place = { x: 0, z: 0, heading: 0 };
    this.world.place(entity, this.progress(), place);
    return { entity, ...place };
  }

  draw() {
    this.dirty = false;
    this.drawn = performance.now();
    const { context, camera } = this;
    const followed = this.follow ? this.shown(this.session.selected) : null;
    if (followed) {
      camera.centre(followed.x, followed.z);
      this.world.area = camera.area(40);
    }
    context.setTransform(this.density, 0, 0, this.density, 0, 0);
    context.fillStyle = '#11171c';
    context.fillRect(0, 0, camera.width, camera.height);
    if (!this.world.info) return;
    this.ground.draw(context, camera, this.density);
    drawGrid(context, camera, this.ground.missing);
    this.drawObjectives();
    this.drawEntities();
    this.drawBlasts();
    this.drawChosen();
    drawScaleBar(context, camera);
  }

  /** Draws the objectives of the battle in the colours of the forces that hold them, with their names. */
  drawObjectives() {
    const { context, camera, world } = this;
    const holders = world.state?.battle?.objectives ?? {};
    for (const { name, x0, z0, x1, z1 } of world.info.objectives ?? []) {
      const force = Math.max(world.info.forces.indexOf(holders[name]), 0);
      const px = camera.px(x0), py = camera.py(z0), width = camera.px(x1) - px, height = camera.py(z1) - py;
      context.fillStyle = context.strokeStyle = FILL[force];
      context.globalAlpha = 0.14;
      context.fillRect(px, py, width, height);
      context.globalAlpha = 0.9;
      context.lineWidth = 1.2;
      context.strokeRect(px, py, width, height);
      context.globalAlpha = 1;
      if (width < OBJECTIVE_NAMED_PX) continue;
      context.font = '600 12px system-ui, "DejaVu Sans", sans-serif';
      drawLabel(context, name, px + 3, py + 3);
    }
  }

  drawEntities() {
    const { context, camera, world } = this;
    const progress = this.progress();
    const place = { x: 0, z: 0, heading: 0 };
    /** @type {{entity: any, px: number, py: number, heading: number}[]} */
    const seen = [];
    for (const entity of world.entities) {
      world.place(entity, progress, place);
      const px = camera.px(place.x), py = camera.py(place.z);
      if (px < -30 || py < -30 || px > camera.width + 30 || py > camera.height + 30) continue;
      seen.push({ entity, px, py, heading: place.heading });
    }
    if (this.showTracks) this.drawTracks(seen);
    this.crowd = seen.length > SYMBOLS_MOST;
    const dots = this.crowd || camera.scale > FORMS_BELOW_MPP * 1.5;
    for (const { entity, px, py } of seen) {
      if (entity[STATE] === STATE_WRECK) {
        if (dots) this.dot(px, py, '#0a0806', 2);
        else drawWreck(context, px, py, this.pixels(entity));
      }
    }
    for (const { entity, px, py, heading } of seen) {
      const kind = world.kind(entity[KIND]);
      if (entity[STATE] === STATE_WRECK) continue;
      if (kind.domain === 'munition') {
        if (dots) this.dot(px, py, '#fffae1', 1);
        else drawMunition(context, px, py, heading);
      } else if (dots) {
        this.drawDot(entity, px, py);
      } else {
        drawVehicle(context, formOf(kind), px, py, heading, this.pixels(entity), entity[FORCE], entity[TURRET]);
        if (entity[DRIVEN]) this.drawDriver(entity, px, py, this.pixels(entity) * 0.95);
      }
    }
  }

  /** Draws a dot, whose shape shows the force: square, upright or flat. */
  drawDot(entity, px, py) {
    const { context } = this;
    const force = entity[FORCE];
    const w = force === 2 ? 3 : force === 1 ? 4 : 5, h = force === 2 ? 6 : force === 1 ? 4 : 3;
    context.fillStyle = 'rgba(6, 8, 10, 0.7)';
    context.fillRect(px - w / 2 - 1, py - h / 2 - 1, w + 2, h + 2);
    context.fillStyle = FILL[force];
    context.fillRect(px - w / 2, py - h / 2, w, h);
    if (entity[DRIVEN]) this.drawDriver(entity, px, py, 6);
  }

  /** Marks a driven vehicle with a ring and the driver's name. */
  drawDriver(entity, px, py, radius) {
    this.ring(px, py, radius, entity[DRIVEN] === DRIVEN_BY_ANOTHER);
    const name = this.world.players.get(entity[ID]);
    if (!name || entity[ID] === this.session.driven) return;
    this.context.textAlign = 'center';
    this.context.font = '600 12px system-ui, "DejaVu Sans", sans-serif';
    drawLabel(this.context, name, px, py - radius - 16);
    this.context.textAlign = 'left';
  }

  dot(px, py, style, half) {
    this.context.fillStyle = style;
    this.context.fillRect(px - half, py - half, 2 * half, 2 * half);
  }

  ring(px, py, radius, broken = false) {
    const { context } = this;
    context.beginPath();
    context.arc(px, py, radius, 0, 2 * Math.PI);
    context.lineWidth = 2;
    context.strokeStyle = '#ffffff';
    if (broken) context.setLineDash([4, 3]);
    context.stroke();
    context.setLineDash([]);
  }

  drawTracks(seen) {
    const { context, camera } = this;
    if (camera.scale > FORMS_BELOW_MPP || seen.length > SYMBOLS_MOST) return;
    context.lineWidth = 1.4;
    context.globalAlpha = 0.55;
    for (let force = 0; force < FILL.length; force++) {
      context.strokeStyle = FILL[force];
      context.beginPath();
      for (const { entity, px, py } of seen) {
        if (entity[FORCE] === force) this.trails.trace(context, camera, entity[ID], px, py);
      }
      context.stroke();
    }
    context.globalAlpha = 1;
  }

  /** [CSS pixel] the length of a symbol: its true length, but at least the minimum. */
  pixels(entity) {
    const least = this.camera.scale > FORMS_BELOW_MPP ? SYMBOL_PX * 0.7 : SYMBOL_PX;
    return Math.max(this.world.kind(entity[KIND]).length_m / this.camera.scale, least);
  }

  drawBlasts() {
    const now = performance.now();
    this.blasts = this.blasts.filter((blast) => now - blast.at < BLAST_MS);
    for (const { x, z, at, large } of this.blasts) {
      const px = this.camera.px(x), py = this.camera.py(z);
      const pixels = (large ? 18 : 10) * (this.camera.scale > FORMS_BELOW_MPP ? 0.5 : 1);
      drawBlast(this.context, px, py, this.calm.matches ? 0.2 : (now - at) / BLAST_MS, pixels);
    }
  }

  drawChosen() {
    const { context, camera } = this;
    for (const id of new Set([this.session.driven, this.session.selected])) {
      const shown = id ? this.shown(id) : null;
      if (!shown) continue;
      const px = camera.px(shown.x), py = camera.py(shown.z);
      const radius = Math.max(this.pixels(shown.entity) * 0.95, 10);
      this.drawSight(px, py, shown.heading + shown.entity[TURRET], radius);
      this.ring(px, py, radius);
      context.textAlign = 'center';
      context.font = '600 12px system-ui, "DejaVu Sans", sans-serif';
      drawLabel(context, this.world.name(id), px, py + radius + 4);
      context.textAlign = 'left';
    }
    if (this.pin) {
      const px = camera.px(this.pin.x), py = camera.py(this.pin.z);
      this.ring(px, py, 13, true);
      this.ring(px, py, 3);
    }
  }

  /** Draws the triangle of the camera's view. */
  drawSight(px, py, direction, radius) {
    const { context } = this;
    const reach = radius + 70;
    context.beginPath();
    context.moveTo(px, py);
    context.lineTo(px + reach * Math.sin(direction - 0.4), py - reach * Math.cos(direction - 0.4));
    context.lineTo(px + reach * Math.sin(direction + 0.4), py - reach * Math.cos(direction + 0.4));
    context.closePath();
    context.fillStyle = 'rgba(255, 255, 255, 0.14)';
    context.fill();
    context.lineWidth = 1;
    context.strokeStyle = 'rgba(255, 255, 255, 0.5)';
    context.stroke();
  }

  /** @returns {number} the id of the vehicle nearest to a place of the canvas, 0 for none near it */
  nearest(px, py) {
    let best = 0, least = NEAR_PX * NEAR_PX;
    const progress = this.progress();
    const place = { x: 0, z: 0, heading: 0 };
    for (const entity of this.world.entities) {
      if (this.world.kind(entity[KIND]).domain === 'munition') continue;
      this.world.place(entity, progress, place);
      const dx = this.camera.px(place.x) - px, dy = this.camera.py(place.z) - py;
      const wreck = entity[STATE] === STATE_WRECK ? 100 : 0;
      const far = dx * dx + dy * dy + wreck;
      if (far < least) {
        least = far;
        best = entity[ID];
      }
    }
    return best;
  }

  /** Centres the map on a place, close enough to see single vehicles. */
  show(x, z) {
    this.camera.centre(x, z);
    if (this.camera.scale > 6) this.camera.zoom(6 / this.camera.scale);
    this.touch();
  }

  /** Marks the place of an event. */
  showEvent(x, z) {
    this.pin = { x, z };
    this.show(x, z);
  }

  /** The place of an entity in the newest state, or null. */
  where(id) {
    const entity = this.world.now.get(id);
    return entity ? { x: entity[X], z: entity[Z], heading: entity[HEADING] } : null;
  }
}
