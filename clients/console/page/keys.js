/**
 * The keyboard: the longer a key is held, the further its lever moves; when it is released, the
 * lever returns. Keys with a single action trigger it at once.
 */

/** code: [lever, direction] */
const LEVERS = {
  KeyW: ['throttle', 1], ArrowUp: ['throttle', 1], KeyS: ['throttle', -1], ArrowDown: ['throttle', -1],
  KeyD: ['steer', 1], ArrowRight: ['steer', 1], KeyA: ['steer', -1], ArrowLeft: ['steer', -1],
  KeyE: ['traverse', 1], KeyQ: ['traverse', -1], KeyR: ['rise', 1], KeyF: ['rise', -1],
  KeyB: ['brake', 1],
};
/** How far a press moves a lever at once ... */
const FIRST = 0.35;
/** ... and the time in seconds of the rest, and of the return. */
const TO_FULL_S = { throttle: 0.6, steer: 0.7, traverse: 0.6, rise: 0.6, brake: 0.3 };
const BACK_S = 0.12;

/** Returns true while a field, a list or a dialog has the keys. */
function isTyping(target) {
  return target instanceof Element &&
    target.closest('input, select, textarea, dialog, [role="tablist"]') !== null;
}

export class Keys {
  /** @param {Record<string, () => void>} actions by KeyboardEvent.code */
  constructor(actions) {
    /** @type {Set<string>} */
    this.held = new Set();
    this.levers = { throttle: 0, steer: 0, traverse: 0, rise: 0, brake: 0 };
    this.driving = false;
    addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey || isTyping(event.target)) return;
      if (this.driving && event.code in LEVERS) {
        this.held.add(event.code);
        event.preventDefault();
      } else if (event.code in actions) {
        if (event.code === 'Space' && event.target instanceof HTMLButtonElement) return;
        event.preventDefault();
        if (!event.repeat) actions[event.code]();
      }
    });
    addEventListener('keyup', (event) => this.held.delete(event.code));
    addEventListener('blur', () => this.held.clear());
  }

  /** Moves the levers on. @param {number} dt [s] @returns {Keys['levers']} */
  step(dt) {
    for (const lever of Object.keys(this.levers)) {
      let way = 0;
      for (const code of this.held) if (LEVERS[code][0] === lever) way += LEVERS[code][1];
      way = Math.sign(way);
      const at = this.levers[lever];
      if (way === 0) {
        const back = Math.max(Math.abs(at) - dt / BACK_S, 0);
        this.levers[lever] = Math.sign(at) * back;
      } else {
        const from = at * way < FIRST ? FIRST : at * way;
        this.levers[lever] = way * Math.min(from + ((1 - FIRST) * dt) / TO_FULL_S[lever], 1);
      }
    }
    return this.levers;
  }

  /** Releases every key. */
  rest() {
    this.held.clear();
    for (const lever of Object.keys(this.levers)) this.levers[lever] = 0;
  }
}
