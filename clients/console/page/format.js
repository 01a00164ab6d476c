/** Numbers and times as people read them. */

/** @type {Intl.NumberFormat[]} by digits after the point; cached because they are slow to make */
const FORMATS = [];

/**
 * @param {number | undefined} value
 * @param {number} [digits] after the point
 * @returns {string}
 */
export function number(value, digits = 0) {
  if (value === undefined || value === null || !Number.isFinite(value)) return '–';
  const rounded = Number(value.toFixed(digits));
  FORMATS[digits] ??= new Intl.NumberFormat('en', { minimumFractionDigits: digits, maximumFractionDigits: digits });
  const text = FORMATS[digits].format(Math.abs(rounded));
  return rounded < 0 ? `−${text}` : text;
}

/** @param {number} seconds of simulation @returns {string} 1:02:03.4 */
export function time(seconds) {
  if (!Number.isFinite(seconds)) return '–';
  const tenths = Math.floor(seconds * 10 + 1e-6);
  const hours = Math.floor(tenths / 36000);
  const minutes = Math.floor(tenths / 600) % 60;
  const rest = ((tenths % 600) / 10).toFixed(1).padStart(4, '0');
  return hours > 0 ? `${hours}:${String(minutes).padStart(2, '0')}:${rest}` : `${minutes}:${rest}`;
}

/** @param {number} metres @returns {string} 250 m, 5 km */
export function distance(metres) {
  return metres >= 1000 ? `${number(metres / 1000, metres % 1000 ? 1 : 0)} km` : `${number(metres)} m`;
}

/** @param {number} part @param {number} whole @returns {string} 93% */
export function share(part, whole) {
  return whole > 0 ? `${Math.round((100 * part) / whole)}%` : '–';
}

/** @param {string} word as the program writes it @returns {string} back off */
export function words(word) {
  return String(word).replaceAll('_', ' ').replaceAll('-', ' ');
}

/** Sets an element's text if it is another one. */
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}
