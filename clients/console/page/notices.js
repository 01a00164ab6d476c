/** Notices of results, which disappear by themselves. */

const STAY_MS = 6000;
const MOST = 4;

export class Notices {
  /** @param {HTMLElement} place */
  constructor(place) {
    this.place = place;
  }

  /**
   * @param {string} text
   * @param {'good' | 'bad'} kind
   */
  show(text, kind = 'good') {
    const same = [...this.place.children].find((line) => line.textContent === text);
    same?.remove();
    const line = document.createElement('p');
    line.textContent = text;
    line.className = kind;
    this.place.append(line);
    while (this.place.children.length > MOST) this.place.firstElementChild.remove();
    setTimeout(() => line.remove(), STAY_MS);
  }
}

/**
 * Asks for confirmation.
 * @param {string} question
 * @param {string} yes what the button says
 * @returns {Promise<boolean>}
 */
export function ask(question, yes) {
  const dialog = /** @type {HTMLDialogElement} */ (document.getElementById('ask'));
  document.getElementById('ask-text').textContent = question;
  document.getElementById('ask-yes').textContent = yes;
  dialog.returnValue = 'no';
  dialog.showModal();
  return new Promise((resolve) => {
    dialog.addEventListener('close', () => resolve(dialog.returnValue === 'yes'), { once: true });
  });
}
