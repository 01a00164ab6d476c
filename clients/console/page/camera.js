/** The part of the world that the map shows: its centre and the metres a pixel. */

const CLOSEST_M = 60;

export class Camera {
  constructor() {
    this.x = 25000;
    this.z = 25000;
    this.side = 50000;
    this.width = 1;
    this.height = 1;
    /** [m] a CSS pixel */
    this.scale = 50;
  }

  /** @param {number} side [m] of the world's square; shows all of it */
  showAll(side) {
    this.side = side;
    this.x = this.z = side / 2;
    this.scale = this.widest();
  }

  /** The scale at which the whole world is visible. */
  widest() {
    return this.side / Math.min(this.width, this.height);
  }

  resize(width, height) {
    this.width = Math.max(width, 1);
    this.height = Math.max(height, 1);
    this.bound();
  }

  /** Zooms about a place of the canvas, which keeps its place in the world. */
  zoom(factor, px = this.width / 2, py = this.height / 2) {
    const x = this.worldX(px), z = this.worldZ(py);
    this.scale = Math.min(Math.max(this.scale * factor, CLOSEST_M / this.width), this.widest() * 1.1);
    this.x = x - (px - this.width / 2) * this.scale;
    this.z = z - (py - this.height / 2) * this.scale;
    this.bound();
  }

  pan(dx, dy) {
    this.x -= dx * this.scale;
    this.z -= dy * this.scale;
    this.bound();
  }

  centre(x, z) {
    this.x = x;
    this.z = z;
    this.bound();
  }

  bound() {
    this.x = Math.min(Math.max(this.x, 0), this.side);
    this.z = Math.min(Math.max(this.z, 0), this.side);
  }

  px(x) {
    return (x - this.x) / this.scale + this.width / 2;
  }

  py(z) {
    return (z - this.z) / this.scale + this.height / 2;
  }

  worldX(px) {
    return this.x + (px - this.width / 2) * this.scale;
  }

  worldZ(py) {
    return this.z + (py - this.height / 2) * this.scale;
  }

  /** @returns {[number, number, number, number]} x0, z0, x1, z1 [m], with a margin */
  area(margin = 0) {
    const w = (this.width / 2 + margin) * this.scale, h = (this.height / 2 + margin) * this.scale;
    return [this.x - w, this.z - h, this.x + w, this.z + h];
  }
}
