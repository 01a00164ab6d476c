/**
 * Where a vehicle is that the server has told: it turns and gains speed evenly for a while, and then goes straight
 * on. The server tells it again when that is no longer near enough.
 */

import { HEADING, SPEED, X, Z } from './world.js';

/** Members of an entity that is asked for with `since`, behind those of each. */
export const ROW = 12;
const TIME = 13, VX = 14, VZ = 15, TURN = 16, GAIN = 17, LASTS = 18;
const MEMBERS = 12;

/**
 * @param {number[]} told an entity as the server told it; what is zero at its end is left out
 * @param {number} time_s of the simulation
 * @returns {any} the entity at that time
 */
export function entityAt(told, time_s) {
  const entity = told.slice(0, MEMBERS);
  const after = time_s - told[TIME];
  if (told.length <= VX || !(after > 0)) return entity;
  const turning = Math.min(after, told[LASTS] ?? 0);
  let vx = told[VX], vz = told[VZ];
  if (turning > 0) {
    const turned = told[TURN] * turning, heading = told[HEADING], half = heading + turned / 2;
    const chord = turned === 0 ? 1 : Math.sin(turned / 2) / (turned / 2);
    const forward = vx * Math.sin(heading) - vz * Math.cos(heading);
    const right = vx * Math.cos(heading) + vz * Math.sin(heading);
    const gained = told[GAIN] * turning;
    const ahead = chord * (forward + gained / 2) * turning, aside = chord * right * turning;
    entity[X] += ahead * Math.sin(half) + aside * Math.cos(half);
    entity[Z] += aside * Math.sin(half) - ahead * Math.cos(half);
    entity[HEADING] = (heading + turned + 2 * Math.PI) % (2 * Math.PI);
    entity[SPEED] = Math.max(entity[SPEED] + gained, 0);
    vx = (forward + gained) * Math.sin(entity[HEADING]) + right * Math.cos(entity[HEADING]);
    vz = right * Math.sin(entity[HEADING]) - (forward + gained) * Math.cos(entity[HEADING]);
  }
  entity[X] += vx * (after - turning);
  entity[Z] += vz * (after - turning);
  return entity;
}
