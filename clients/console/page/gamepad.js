/** Reads a gamepad of the standard layout: sticks and triggers as values, buttons as actions. */

const DEAD = 0.08;
const FIRE = 0, BRAKE = 1, VIEW = 2, GEAR = 3, TRIGGER_BACK = 6, TRIGGER_ON = 7;

function stick(value = 0) {
  const beyond = Math.abs(value) - DEAD;
  return beyond > 0 ? (Math.sign(value) * beyond) / (1 - DEAD) : 0;
}

export class Pads {
  /** @param {{fire: () => void, gear: () => void, view: () => void}} actions */
  constructor(actions) {
    this.actions = actions;
    /** @type {boolean[]} */
    this.before = [];
  }

  /** @returns {{throttle: number, steer: number, traverse: number, rise: number, brake: number} | null} */
  step() {
    const pad = [...(navigator.getGamepads?.() ?? [])].find((one) => one?.connected);
    if (!pad) return null;
    const pressed = pad.buttons.map((button) => button.pressed);
    for (const [index, action] of [[FIRE, this.actions.fire], [GEAR, this.actions.gear], [VIEW, this.actions.view]]) {
      if (pressed[index] && !this.before[index]) action();
    }
    this.before = pressed;
    const pull = (index) => pad.buttons[index]?.value ?? 0;
    return {
      throttle: pull(TRIGGER_ON) - pull(TRIGGER_BACK),
      steer: stick(pad.axes[0]),
      traverse: stick(pad.axes[2]),
      rise: -stick(pad.axes[3]),
      brake: pull(BRAKE),
    };
  }
}
