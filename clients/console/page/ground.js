/**
 * The ground of the map: square tiles from the renderer, each level of detail twice as fine as the
 * previous one. Tiles are cached; while a finer tile is loading, a coarser one is drawn instead.
 */

const TILE_PX = 512;
const FINEST = 9;
const KEPT = 160;
const ASKED_AT_ONCE = 2;
const AGAIN_MS = 2000;

/** @typedef {{image: ImageBitmap | null, used: number, retry: number, asked: boolean}} Tile */

export class Ground {
  /**
   * @param {import('./api.js').Api} api
   * @param {() => void} redraw called when a tile has come
   */
  constructor(api, redraw) {
    this.api = api;
    this.redraw = redraw;
    /** @type {Map<string, Tile>} */
    this.tiles = new Map();
    this.asked = 0;
    this.missing = false;
  }

  /** Forgets all tiles, for another world or another ground. */
  clear() {
    for (const tile of this.tiles.values()) tile.image?.close();
    this.tiles.clear();
  }

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {import('./camera.js').Camera} camera
   * @param {number} density pixels of the screen a CSS pixel
   */
  draw(context, camera, density) {
    const wanted = Math.log2((camera.side / TILE_PX) * (density / camera.scale));
    const level = Math.min(Math.max(Math.round(wanted), 0), FINEST);
    const metres = camera.side / 2 ** level, last = 2 ** level - 1;
    const [x0, z0, x1, z1] = camera.area();
    const within = (v) => Math.min(Math.max(Math.floor(v / metres), 0), last);
    this.missing = false;
    /** @type {[number, number, number, number][]} nearest to the middle first */
    const order = [];
    for (let row = within(z0); row <= within(z1); row++) {
      for (let column = within(x0); column <= within(x1); column++) {
        const dx = (column + 0.5) * metres - camera.x, dz = (row + 0.5) * metres - camera.z;
        order.push([dx * dx + dz * dz, level, column, row]);
        this.drawTile(context, camera, level, column, row);
      }
    }
    order.sort((a, b) => a[0] - b[0]);
    if (!this.tiles.get('0/0/0')?.image) this.ask(camera.side, 0, 0, 0);
    for (const [, l, column, row] of order) this.ask(camera.side, l, column, row);
  }

  drawTile(context, camera, level, column, row) {
    for (let up = 0; up <= level; up++) {
      const tile = this.tiles.get(`${level - up}/${column >> up}/${row >> up}`);
      if (!tile?.image) continue;
      tile.used = performance.now();
      const metres = camera.side / 2 ** level, part = TILE_PX / 2 ** up, mask = 2 ** up - 1;
      const left = Math.round(camera.px(column * metres)), top = Math.round(camera.py(row * metres));
      const right = Math.round(camera.px((column + 1) * metres));
      const bottom = Math.round(camera.py((row + 1) * metres));
      context.drawImage(tile.image, (column & mask) * part, (row & mask) * part, part, part,
        left, top, right - left, bottom - top);
      return;
    }
    this.missing = true;
  }

  async ask(side, level, column, row) {
    const name = `${level}/${column}/${row}`;
    const known = this.tiles.get(name);
    if (known && (known.image || known.asked || performance.now() < known.retry)) return;
    if (this.asked >= ASKED_AT_ONCE) return;
    const tile = known ?? { image: null, used: performance.now(), retry: 0, asked: false };
    this.tiles.set(name, tile);
    tile.asked = true;
    this.asked++;
    const metres = side / 2 ** level;
    const query = `x=${(column + 0.5) * metres}&z=${(row + 0.5) * metres}&metres=${metres}&size=${TILE_PX}x${TILE_PX}`;
    try {
      const response = await this.api.fetch(`/api/map?${query}`);
      tile.image = await createImageBitmap(await response.blob());
    } catch {
      tile.retry = performance.now() + AGAIN_MS;
    }
    tile.asked = false;
    this.asked--;
    this.drop();
    this.redraw();
  }

  /** Evicts the tiles that were not drawn for longest, but never the coarsest. */
  drop() {
    if (this.tiles.size <= KEPT) return;
    const old = [...this.tiles].filter(([name, tile]) => name !== '0/0/0' && !tile.asked)
      .sort((a, b) => a[1].used - b[1].used);
    for (const [name, tile] of old.slice(0, this.tiles.size - KEPT)) {
      tile.image?.close();
      this.tiles.delete(name);
    }
  }
}
