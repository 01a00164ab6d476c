/**
 * Pointers on the picture: press and drag anywhere to aim, double click to fire; on a touch screen
 * two virtual sticks, one to drive and one to aim.
 */

const REACH_PX = 130;

/**
 * A virtual stick centred where it is pressed. It reports how far it is pulled, -1 to 1.
 * @param {HTMLElement} place
 * @param {number} reach [CSS pixel] for 1
 * @param {(x: number, y: number) => void} moved y up
 */
function stick(place, reach, moved) {
  let from = null;
  place.addEventListener('pointerdown', (event) => {
    if (event.button !== 0 || event.target.closest('button')) return;
    place.setPointerCapture(event.pointerId);
    from = { id: event.pointerId, x: event.clientX, y: event.clientY };
    event.stopPropagation();
  });
  place.addEventListener('pointermove', (event) => {
    if (from?.id !== event.pointerId) return;
    const pull = (d) => Math.min(Math.max(d / reach, -1), 1);
    moved(pull(event.clientX - from.x), pull(from.y - event.clientY));
  });
  const end = (event) => {
    if (from?.id !== event.pointerId) return;
    from = null;
    moved(0, 0);
  };
  place.addEventListener('pointerup', end);
  place.addEventListener('pointercancel', end);
}

export class Hands {
  /**
   * @param {HTMLElement} picture
   * @param {HTMLElement} pad
   * @param {() => void} fire
   */
  constructor(picture, pad, fire) {
    this.levers = { throttle: 0, steer: 0, traverse: 0, rise: 0, brake: 0 };
    this.pad = pad;
    this.touch = matchMedia('(pointer: coarse)');
    const aim = (x, y) => Object.assign(this.levers, { traverse: x, rise: y });
    stick(picture, REACH_PX, aim);
    picture.addEventListener('dblclick', (event) => {
      if (!event.target.closest('button')) fire();
    });
    for (const [id, moved] of [['pad-stick', (x, y) => Object.assign(this.levers, { steer: x, throttle: y })],
      ['pad-aim', aim]]) {
      const place = document.getElementById(id), knob = place.querySelector('i');
      stick(place, 44, (x, y) => {
        moved(x, y);
        knob.style.transform = `translate(${26 * x}px, ${-26 * y}px)`;
      });
    }
  }

  /** Shows the sticks of a touch screen while somebody drives. */
  show(driving) {
    this.pad.hidden = !(driving && this.touch.matches);
  }
}
