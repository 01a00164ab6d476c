/** What the tests of the page share: a browser, TAP lines, and what the world itself says. */

import { execFileSync } from 'node:child_process';
import { createRequire } from 'node:module';
import path from 'node:path';

const { BROWSER, MODULES, JOLON_BIN, WORLD, SHOTS } = process.env;
const { chromium } = createRequire(`${MODULES}/`)('playwright-core');

/** How long something may take on a machine that has other work. */
const PATIENCE_MS = 60000;

/** The page's own complaints. A refused answer is one too, but what it says is the page's to show. */
export const complaints = [];

/** The open pages, for pictures of the first failure. */
const pages = [];
let number = 0;
export let failures = 0;

/** @param {string} name @param {() => Promise<any>} deed throws, or gives false, when it fails */
export async function check(name, deed) {
  number++;
  try {
    const answer = await deed();
    if (answer === false) throw new Error('it is not so');
    console.log(`ok ${number} - ${name}`);
  } catch (error) {
    failures++;
    console.log(`not ok ${number} - ${name}`);
    // What fails after the first failure mostly follows from it: one line is enough.
    const told = String(error.stack).split('\n').slice(0, failures === 1 ? 12 : 1);
    console.log(told.map((line) => `# ${line}`).join('\n'));
    if (failures === 1) await Promise.all(pages.map(show));
  }
}

/** Prints the notices of a page, and takes its picture. */
async function show(page, i) {
  for (const notice of await page.locator('#notices p').allTextContents()) console.log(`# page ${i + 1} says: ${notice}`);
  await shot(page, `failure-${i + 1}`);
}

/** Waits until a deed gives something true. */
export async function eventually(deed, what, limit_ms = PATIENCE_MS) {
  const end = Date.now() + limit_ms;
  let last;
  while (Date.now() < end) {
    last = await deed();
    if (last) return last;
    await new Promise((resolve) => setTimeout(resolve, 60));
  }
  throw new Error(`not within ${limit_ms / 1000} s: ${what}`);
}

export async function openBrowser() {
  const args = ['--disable-gpu', '--disable-dev-shm-usage', ...(process.getuid() === 0 ? ['--no-sandbox'] : [])];
  return chromium.launch({ executablePath: BROWSER, args });
}

/** A page of a person of its own. */
export async function openPage(browser, url, width, height, options = {}) {
  const context = await browser.newContext({ viewport: { width, height }, ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(PATIENCE_MS);
  page.on('pageerror', (error) => complaints.push(error.stack));
  page.on('console', (message) => {
    const refused = /^Failed to load resource: the server responded with a status of \d+/.test(message.text());
    if (['error', 'warning'].includes(message.type()) && !refused) complaints.push(message.text());
  });
  page.on('response', (response) => {
    if (response.status() === 429) complaints.push(`too often: ${response.url()}`);
  });
  pages.push(page);
  page.on('close', () => pages.splice(pages.indexOf(page), 1));
  await page.goto(url);
  return page;
}

export async function shot(page, name) {
  await page.screenshot({ path: path.join(SHOTS, `${name}.png`), timeout: PATIENCE_MS });
}

export function jolon(...words) {
  return execFileSync(path.join(JOLON_BIN, 'jolon'), words, { encoding: 'utf8' });
}

/** Every entity of the world's table, by name. */
export function dump() {
  const text = execFileSync(path.join(JOLON_BIN, 'jolon-world'), ['dump', '--world', WORLD, '--json'],
    { encoding: 'utf8', maxBuffer: 1 << 26 });
  const all = text.trim().split('\n').map((line) => JSON.parse(line));
  return new Map(all.map((entity) => [entity.name || String(entity.id), entity]));
}

/** The text of an element. */
export function text(page, selector) {
  return page.locator(selector).textContent();
}
