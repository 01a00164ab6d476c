/**
 * People at the page: one takes a tank, drives it, fires, kills the renderer; another has a vehicle of
 * their own; a third only watches.
 */

import { check, complaints, dump, eventually, failures, jolon, openBrowser, openPage, shot, text } from './page.mjs';

const { URL: address, WORLD } = process.env;
const browser = await openBrowser();
const ada = await openPage(browser, address, 1440, 900);

/** Finds a vehicle in the list, and brings it into view and into the middle of the map. */
async function find(page, name) {
  await page.click('#tab-list');
  await page.fill('#list-search', name);
  await page.locator('#list-rows tr', { hasText: name }).first().click();
  await eventually(async () => (await text(page, '#v-name')) === name, `${name} in view`);
}

/** A place of the map, off its middle. */
async function mapPlace(page, dx = 0, dy = 0) {
  const box = await page.locator('#map').boundingBox();
  return [box.x + box.width / 2 + dx, box.y + box.height / 2 + dy];
}

const travelled = (from, to) => Math.hypot(to.position[0] - from.position[0], to.position[2] - from.position[2]);

async function drives(page, name, metres) {
  const from = dump().get(name);
  await page.locator('#picture').focus();
  await page.keyboard.down('KeyW');
  try {
    await eventually(() => travelled(from, dump().get(name)) > metres, `${name} moved ${metres} m`);
  } finally {
    await page.keyboard.up('KeyW');
  }
}

/* --- one person ------------------------------------------------------------------------------ */

await check('the page shows the running world', async () => {
  await eventually(async () => (await text(ada, '#world-state')) === 'running', 'running');
  await eventually(async () => (await text(ada, '#g-vehicles')) === String(dump().size), 'all vehicles');
});
await check('the token is not left in the address', () => !ada.url().includes('token'));
await check('one joins with a name', async () => {
  await ada.fill('#join-name', 'Ada');
  await ada.click('#join button');
  await eventually(async () => (await text(ada, '#player')) === 'Ada', 'her name');
});
await check('pictures come', () => eventually(async () => Number(await ada.locator('#picture').getAttribute('data-pictures')) > 2,
  'three pictures'));
await check('a double click on the map takes a tank', async () => {
  await find(ada, 'Alpha');
  await ada.mouse.dblclick(...await mapPlace(ada));
  await eventually(() => dump().get('Alpha').behaviour === 'driven', 'Alpha driven');
  await eventually(async () => (await text(ada, '#driving-name')) === 'Alpha', 'the page says so');
});
await check('the keyboard drives it', () => drives(ada, 'Alpha', 8));
await check('a gamepad drives it', async () => {
  const from = dump().get('Alpha');
  await ada.evaluate(() => {
    const buttons = Array.from({ length: 16 }, (_, i) => ({ pressed: i === 7, value: i === 7 ? 1 : 0 }));
    navigator.getGamepads = () => [{ connected: true, axes: [0, 0, 0, 0], buttons }];
  });
  await eventually(() => travelled(from, dump().get('Alpha')) > 5, 'Alpha moved');
  await ada.evaluate(() => { navigator.getGamepads = () => []; });
});
await check('the mouse aims', async () => {
  const box = await ada.locator('#picture').boundingBox();
  const turret = await text(ada, '#s-turret');
  await ada.mouse.move(box.x + 300, box.y + 200);
  await ada.mouse.down();
  await ada.mouse.move(box.x + 420, box.y + 200, { steps: 4 });
  await eventually(async () => (await text(ada, '#s-turret')) !== turret, 'the turret turns');
  await ada.mouse.up();
});
await check('its speed shows', () => eventually(async () => parseFloat(await text(ada, '#s-speed')) > 0, 'a speed'));
await check('it fires, and the feed says so', async () => {
  await ada.click('#tab-feed');
  await ada.locator('#picture').focus();
  await ada.keyboard.press('Space');
  await eventually(() => dump().get('Alpha').rounds < 55, 'a round less');
  await ada.locator('#feed-rows li', { has: ada.locator('.what.fire') }).filter({ hasText: 'Alpha' }).first().waitFor();
});
await shot(ada, 'driving-1440x900');
await check('a click on an event shows its place', async () => {
  await ada.locator('#feed-rows li', { has: ada.locator('.what.fire') }).filter({ hasText: 'Alpha' }).first().locator('button').click();
  await eventually(async () => (await text(ada, '#v-name')) === 'Alpha', 'who fired');
});
await check('one changes vehicle while one steers', async () => {
  await find(ada, 'Bravo');
  await ada.locator('#picture').focus();
  await ada.keyboard.down('KeyA');
  await ada.click('#v-take');
  await ada.keyboard.up('KeyA');
  await eventually(() => dump().get('Bravo').behaviour === 'driven', 'Bravo driven');
  await eventually(() => dump().get('Alpha').behaviour !== 'driven', 'Alpha back to its agent');
});
await check('statistics are those of the table', async () => {
  await drives(ada, 'Bravo', 2);
  await ada.click('#pause');
  await eventually(async () => (await text(ada, '#world-state')) === 'paused', 'paused');
  await ada.waitForTimeout(500);
  const row = dump().get('Bravo');
  const value = async (id) => parseFloat((await text(ada, `#s-${id}`)).replace('−', '-').replaceAll(',', ''));
  const wanted = {
    speed: row.speed_mps * 3.6, heading: row.heading_deg, pitch: row.pitch_deg, roll: row.roll_deg,
    altitude: row.position[1], x: row.position[0], z: row.position[2], rounds: row.rounds, fuel: Math.round(row.fuel),
  };
  for (const [id, right] of Object.entries(wanted)) {
    const shown = await value(id);
    // The speed is rounded twice: to 0.01 m/s in the answer, then to 0.1 km/h.
    if (!(Math.abs(shown - right) <= 0.07)) throw new Error(`${id}: the page says ${shown}, the table ${right}`);
  }
  for (const id of ['damage', 'behaviour']) {
    if ((await text(ada, `#s-${id}`)) !== row[id]) throw new Error(`${id} is not ${row[id]}`);
  }
});
await check('a step goes one frame on', async () => {
  const frame = await text(ada, '#g-frame');
  await ada.click('#step');
  await eventually(async () => (await text(ada, '#g-frame')) !== frame, 'another frame');
});
await check('the world goes on', async () => {
  await ada.click('#pause');
  await eventually(async () => (await text(ada, '#world-state')) === 'running', 'running');
});
await check('a click with the tool spawns a vehicle', async () => {
  const before = dump().size;
  await find(ada, 'Bravo');
  await ada.click('[data-tool="spawn"]');
  await ada.selectOption('#spawn-kind', 'truck');
  await ada.mouse.click(...await mapPlace(ada, -80, 90));
  await eventually(() => [...dump().values()].some((entity) => entity.kind === 'truck' && entity.id > before), 'a truck');
  await shot(ada, 'spawn');
  await ada.click('#spawn-form [data-done]');
});
await check('the field takes a place, and the selected tool is used there', async () => {
  const before = dump().size;
  await ada.click('[data-tool="spawn"]');
  await ada.selectOption('#spawn-kind', 'helicopter');
  await ada.fill('#place', '25400,24600');
  await ada.press('#place', 'Enter');
  await eventually(() => [...dump().values()].some((entity) => entity.kind === 'helicopter' && entity.id > before &&
    Math.hypot(entity.position[0] - 25400, entity.position[2] - 24600) < 300), 'a helicopter there');
  await ada.click('#spawn-form [data-done]');
});
await check('what is no place is told', async () => {
  await ada.fill('#place', '91N,71W');
  await ada.press('#place', 'Enter');
  await ada.locator('#notices p.bad', { hasText: 'not a latitude' }).waitFor();
});
await check('a pointer that rests has its place on the earth', async () => {
  await ada.mouse.move(...await mapPlace(ada, -40, 60));
  await eventually(async () => /N,\d.*W · \d\d[A-Z]{3}\d{10}/.test(await text(ada, '#map-where')), 'degrees and MGRS');
});
await check('a fire mission falls where it is wanted', async () => {
  await ada.click('[data-tool="mission"]');
  await ada.fill('#mission-rounds', '2');
  await ada.mouse.click(...await mapPlace(ada, 150, 110));
  await ada.click('#mission-form [data-done]');
  await ada.click('#tab-feed');
  await ada.locator('#feed-rows .what.detonation').first().waitFor();
});
await check('the button kills the renderer, and it comes back', async () => {
  await ada.click('#tab-processes');
  const line = ada.locator('#process-rows tr[data-role="renderer"]');
  const before = await line.locator('td').nth(2).textContent();
  const pictures = Number(await ada.locator('#picture').getAttribute('data-pictures'));
  await line.getByText('Kill', { exact: true }).click();
  await ada.click('#ask-yes');
  await eventually(async () => {
    const cells = await line.locator('td').allTextContents();
    return cells[1] === 'ready' && cells[2] !== before;
  }, 'another renderer, ready');
  await eventually(async () => Number(await ada.locator('#picture').getAttribute('data-pictures')) > pictures + 3,
    'pictures go on');
  await eventually(async () => !(await ada.locator('#picture-note').isVisible()), 'no note over them');
});
await shot(ada, 'processes');

/* --- several people -------------------------------------------------------------------------- */

const bob = await openPage(browser, address, 1024, 700);
await check('a second person has a vehicle of their own', async () => {
  await bob.fill('#join-name', 'Bob');
  await bob.click('#join button');
  await find(bob, 'Alpha');
  await bob.click('#v-take');
  await eventually(() => dump().get('Alpha').behaviour === 'driven', 'Alpha driven');
  await Promise.all([drives(ada, 'Bravo', 3), drives(bob, 'Alpha', 3)]);
});
await check('nobody takes another\'s vehicle', async () => {
  await find(ada, 'Alpha');
  await eventually(async () => (await text(ada, '#v-driver')) === 'Bob drives it' &&
    await ada.locator('#v-take').isDisabled(), 'Bob drives it, and it cannot be taken');
});
await shot(bob, 'second-1024x700');

const eve = await openPage(browser, address.split('#')[0], 390, 844, { hasTouch: true });
await check('a spectator sees all', async () => {
  await eventually(async () => (await text(eve, '#world-state')) === 'running', 'running');
  await find(eve, 'Alpha');
  await eventually(async () => Number(await eve.locator('#picture').getAttribute('data-pictures')) > 1, 'pictures');
});
await check('and has nothing that changes anything, with a line that says why', async () => {
  for (const one of await eve.locator('.changes').all()) if (await one.isVisible()) return false;
  return eve.locator('#spectator').isVisible();
});
await check('nor does the server let them', async () => {
  const before = dump().get('Charlie');
  const status = await eve.evaluate(async (vehicle) => (await fetch('/api/command', {
    method: 'POST', headers: { 'Content-Type': 'application/json' },
    body: JSON.stringify({ do: 'remove', vehicle }),
  })).status, before.id);
  if (status !== 401) throw new Error(`the answer is ${status}`);
  return dump().has('Charlie');
});
await eve.evaluate(() => scrollTo(0, 0));
await shot(eve, 'phone-390x844');
await eve.evaluate(() => document.getElementById('map').scrollIntoView());
await shot(eve, 'phone-map');

await check('who goes away loses the vehicle', async () => {
  await bob.context().close();
  await eventually(() => dump().get('Alpha').behaviour !== 'driven', 'Alpha back to its agent');
});
await check('letting go gives it back', async () => {
  await find(ada, 'Bravo');
  await ada.click('#v-take');
  await eventually(() => dump().get('Bravo').behaviour !== 'driven', 'Bravo back to its agent');
});
await ada.setViewportSize({ width: 2560, height: 1440 });
await ada.waitForTimeout(1200);
await shot(ada, 'wide-2560x1440');
await check('it says so when the world is gone', async () => {
  jolon('stop', '-w', WORLD);
  await eventually(async () => (await text(ada, '#world-state')) !== 'running', 'not running');
});
await shot(ada, 'gone');
await check('the page has nothing to complain of', () => {
  if (complaints.length) throw new Error(complaints.join('\n'));
});

await browser.close();
console.log('# the end');
process.exitCode = failures ? 1 : 0;
