/**
 * Two people at two pages who play until standard input ends: each takes a vehicle from the list, drives
 * about by the keyboard, fires, and takes another one now and then. Then a line of JSON: for each page
 * the commands that it sent and what was answered, and what the page complained of.
 */

import { complaints, eventually, openBrowser, openPage, text } from './page.mjs';

const { URL: address, SEED } = process.env;
const browser = await openBrowser();
let over = false;
process.stdin.on('end', () => { over = true; }).resume();

/** Numbers from a seed, so that a game can be played again: mulberry32. */
function chanceOf(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let mixed = Math.imul(state ^ (state >>> 15), state | 1);
    mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 4294967296;
  };
}

/** Notes every command of a page with its answer. */
function listen(page, answers) {
  page.on('response', async (response) => {
    if (!response.url().endsWith('/api/command')) return;
    const asked = response.request().postDataJSON();
    const answer = await response.json().catch(() => ({}));
    answers.push({ do: asked.do, status: response.status(), ...answer });
  });
}

async function take(page, chance) {
  await page.click('#tab-list');
  const rows = page.locator('#list-rows tr');
  const count = await rows.count();
  if (count === 0) return;
  await rows.nth(Math.floor(chance() * count)).click();
  await page.click('#v-take', { timeout: 2000 });
}

async function play(name, width, height, chance) {
  const answers = [];
  const page = await openPage(browser, address, width, height);
  listen(page, answers);
  await page.fill('#join-name', name);
  await page.click('#join button');
  await eventually(async () => (await text(page, '#player')) === name, `${name} has joined`);
  for (let turn = 0; !over; turn++) {
    if (turn % 25 === 0) await take(page, chance).catch(() => {}); /* a wreck, or somebody else's */
    const key = ['KeyW', 'KeyW', 'KeyA', 'KeyD', 'KeyQ', 'KeyE'][Math.floor(chance() * 6)];
    await page.locator('#picture').focus().catch(() => {});
    await page.keyboard.down(key);
    if (chance() < 0.2) await page.keyboard.press('Space');
    await page.waitForTimeout(150 + chance() * 600);
    await page.keyboard.up(key);
  }
  await page.waitForTimeout(1500); /* what was sent is answered */
  const pictures = Number(await page.locator('#picture').getAttribute('data-pictures'));
  return { name, answers, pictures };
}

const seed = Number(SEED);
const pages = await Promise.all([play('Ann', 1280, 800, chanceOf(seed)), play('Ben', 1024, 700, chanceOf(seed + 1))]);
console.log(JSON.stringify({ pages, complaints }));
await browser.close();
