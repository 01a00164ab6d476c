/**
 * Sends requests to the console's server. Requests that change the world need the token of the
 * link, and driving needs a player's key.
 */

/** A refusal of the server. */
export class Refusal extends Error {
  /**
   * @param {string} message what was refused, and why
   * @param {string} next what to do about it
   * @param {number} status of HTTP; 0 when the server could not be reached
   */
  constructor(message, next, status) {
    super(message);
    this.next = next;
    this.status = status;
  }

  /** Both as sentences. */
  get text() {
    return [this.message, this.next].filter((part) => part)
      .map((part) => part[0].toUpperCase() + part.slice(1) + (/[.!?]$/.test(part) ? '' : '.')).join(' ');
  }
}

const TOKEN_PLACE = 'jolon-token';

/** Reads the link's token and removes it from the address bar, so that it is not copied with the address. */
function takeToken() {
  const found = /^#token=(.+)$/.exec(location.hash);
  if (found) {
    sessionStorage.setItem(TOKEN_PLACE, decodeURIComponent(found[1]));
    history.replaceState(null, '', location.pathname + location.search);
  }
  return sessionStorage.getItem(TOKEN_PLACE) ?? '';
}

export class Api {
  constructor() {
    this.token = takeToken();
    this.key = '';
  }

  /** Whether this page may try to change the world. */
  get mayChange() {
    return this.token !== '';
  }

  /**
   * @param {string} path with its query
   * @param {RequestInit} [options]
   * @returns {Promise<Response>} a good one
   * @throws {Refusal}
   */
  async fetch(path, options = {}) {
    let response;
    try {
      response = await fetch(path, { cache: 'no-store', signal: AbortSignal.timeout(8000), ...options });
    } catch (error) {
      if (options.signal?.aborted) throw error;
      throw new Refusal('The console does not answer.', 'The page connects again as soon as the console runs.', 0);
    }
    if (response.ok) return response;
    const refusal = await response.json().catch(() => ({}));
    throw new Refusal(refusal.error ?? `The console answered ${response.status}.`, refusal.next ?? '', response.status);
  }

  /**
   * @param {string} path below /api/
   * @param {Record<string, string | number>} [query] empty values are left out
   * @returns {Promise<any>}
   */
  async get(path, query = {}) {
    const words = Object.entries(query).filter(([, value]) => value !== '');
    const text = new URLSearchParams(words.map(([name, value]) => [name, String(value)])).toString();
    const headers = this.key ? { 'X-Jolon-Player': this.key } : {};
    return (await this.fetch(`/api/${path}${text ? `?${text}` : ''}`, { headers })).json();
  }

  /**
   * @param {string} path below /api/
   * @param {object} body
   * @returns {Promise<any>}
   */
  async post(path, body) {
    const headers = { 'Content-Type': 'application/json', Authorization: `Bearer ${this.token}` };
    if (this.key) headers['X-Jolon-Player'] = this.key;
    const response = await this.fetch(`/api/${path}`, {
      method: 'POST',
      headers,
      body: JSON.stringify(body),
    });
    return response.json();
  }
}
