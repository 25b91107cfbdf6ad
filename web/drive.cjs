// Drives the page in a browser: numbers, requests, times and pictures.
'use strict';
const { chromium } = require('playwright-core');
const { execFileSync } = require('node:child_process');
const fs = require('node:fs');
const http = require('node:http');
const path = require('node:path');
const zlib = require('node:zlib');

const DIST = process.env.DIST || path.join(__dirname, 'dist');
const SHOTS = path.join(__dirname, 'shots');
const EXAMPLE = path.join(__dirname, '../assets/examples/steel45_simulated.csv');
const KINDS = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm' };
// A subfolder: paths of the page are relative.
const FOLDER = '/course/brdf/';

const figures = {};

const failures = [];

function check(holds, what) {
  if (!holds) failures.push(what);
  console.log(`  ${holds ? 'ok' : 'DOES NOT HOLD'}: ${what}`);
}

function serve() {
  const sent = { bytes: 0 };
  const server = http.createServer((request, response) => {
    const { pathname } = new URL(request.url, 'http://localhost');
    const name = pathname.startsWith(FOLDER) ? pathname.slice(FOLDER.length) || 'index.html' : '';
    const file = path.join(DIST, path.basename(name));
    if (!name || !fs.existsSync(file)) {
      response.writeHead(404).end();
      return;
    }
    const body = zlib.gzipSync(fs.readFileSync(file), { level: 9 });
    sent.bytes += body.length;
    response.writeHead(200, { 'Content-Type': KINDS[path.extname(file)], 'Content-Encoding': 'gzip', 'Cache-Control': 'no-store' }).end(body);
  });
  return new Promise((resolve) => server.listen(0, '127.0.0.1', () => resolve({ server, sent, origin: `http://127.0.0.1:${server.address().port}` })));
}

// Watches for tasks that block the page, and for the time that frames take, from the beginning of the page.
function watch() {
  window.longTasks = [];
  new PerformanceObserver((list) => {
    for (const entry of list.getEntries()) window.longTasks.push({ start: entry.startTime, duration: entry.duration });
  }).observe({ type: 'longtask', buffered: true });
  window.frames_ = [];
  const request = window.requestAnimationFrame.bind(window);
  window.plainFrame = request;
  window.requestAnimationFrame = (callback) =>
    request((time) => {
      const begun = performance.now();
      callback(time);
      window.frames_.push({ at: begun, took: performance.now() - begun });
    });
  new MutationObserver(() => {
    if (!window.firstPicture && document.body && document.getElementById('window') && !document.getElementById('loading')) {
      request(() => request(() => (window.firstPicture = window.firstPicture || performance.now())));
    }
  }).observe(document, { childList: true, subtree: true });
}

const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];

// The work that the page keeps, unpacked; null before it is kept.
async function keptWork(page) {
  const texts = await page.evaluate(() =>
    Object.keys(localStorage).filter((key) => key.includes(':/kept/work/')).map((key) => localStorage.getItem(key)));
  if (texts.length === 0) return null;
  const newest = texts.sort((a, b) => Number(b.split(' ')[0]) - Number(a.split(' ')[0]))[0];
  return JSON.parse(zlib.inflateSync(Buffer.from(newest.split(' ')[1], 'base64url')));
}

async function until(page, holds, what, seconds = 60) {
  const end = Date.now() + seconds * 1000;
  for (;;) {
    const work = await keptWork(page);
    if (work && holds(work)) return work;
    if (Date.now() > end) throw new Error(`does not come: ${what}; kept: ${work ? JSON.stringify(work).slice(0, 600) : 'nothing'}`);
    await page.waitForTimeout(100);
  }
}

// Through the palette of commands, whose field is the only one for a text that the window shows meanwhile.
async function command(page, words) {
  const field = async () => (await widgets(page)).find((one) => one.role === 'TextInput' || one.role === 'SearchInput');
  await page.keyboard.press('Control+Shift+P');
  await comes(page, field, 'the palette opens');
  await page.keyboard.type(words, { delay: 15 });
  await comes(page, async () => (await field())?.value === words, `the palette has ${words}`);
  await page.waitForTimeout(100);
  await page.keyboard.press('Enter');
  await comes(page, async () => !(await field()), 'the palette closes');
  await page.waitForTimeout(200);
}

// What stands where: a page that is opened with `?probe` tells it, as readers of screens are told.
const widgets = async (page) => JSON.parse((await page.evaluate(() => window.widgets)) || '[]');

// The widget of that role and label (a text or a pattern), once it is there.
async function widget(page, role, label, seconds = 20) {
  const end = Date.now() + seconds * 1000;
  for (;;) {
    const all = await widgets(page);
    const fits = (text) => (label instanceof RegExp ? label.test(text) : text === label);
    const found = all.find((one) => one.role === role && (fits(one.label) || fits(one.value)));
    if (found) return found;
    if (Date.now() > end) {
      const there = all.filter((one) => one.role === role).map((one) => one.label || one.value);
      throw new Error(`no ${role} ${label}; there are: ${there.join(' | ')}`);
    }
    await page.waitForTimeout(50);
  }
}

async function comes(page, holds, what, seconds = 20) {
  const end = Date.now() + seconds * 1000;
  while (!(await holds())) {
    if (Date.now() > end) {
      await shot(page, 'fault');
      throw new Error(`does not come: ${what}`);
    }
    await page.waitForTimeout(50);
  }
}

const middle = ({ place: [left, top, right, bottom] }) => [(left + right) / 2, (top + bottom) / 2];

// The longest time between two chances to draw, in so many milliseconds: how long the page was blocked.
function longestGap(milliseconds) {
  return new Promise((resolve) => {
    const begun = performance.now();
    let last = begun;
    let longest = 0;
    const look = () => {
      const now = performance.now();
      longest = Math.max(longest, now - last);
      last = now;
      if (now - begun > milliseconds) resolve(longest);
      else setTimeout(look, 0);
    };
    look();
  });
}

const rounded = (value) => Number(value.toFixed(2));

// What frames took, and how far apart they were.
function told(frames) {
  const gaps = frames.slice(1).map((frame, i) => frame.at - frames[i].at);
  return {
    frames: frames.length,
    median_ms: rounded(median(frames.map((frame) => frame.took))),
    longest_ms: rounded(Math.max(...frames.map((frame) => frame.took))),
    interval_median_ms: rounded(median(gaps)),
    // Where frames wait for the graphics, few take long.
    interval_mean_ms: rounded(gaps.reduce((sum, gap) => sum + gap, 0) / gaps.length),
  };
}

// Drags a slider to the right in 60 steps; what the frames meanwhile took.
async function drag(page, slider) {
  const before = await page.evaluate(() => window.frames_.length);
  const [left, , right] = slider.place;
  const [, y] = middle(slider);
  const from = left + 8 + ((right - left - 16) * 0.55);
  await page.mouse.move(from, y);
  await page.mouse.down();
  for (let step = 1; step <= 60; step += 1) await page.mouse.move(from + step * 0.4, y, { steps: 1 });
  await page.mouse.up();
  await page.waitForTimeout(100);
  return told((await page.evaluate(() => window.frames_)).slice(before));
}

// The same with one move a frame by the page itself: the driver, which waits for an answer after every move, takes no part.
function dragInPage({ place: [left, top, right, bottom] }) {
  const canvas = document.getElementById('window');
  const y = (top + bottom) / 2;
  const from = left + 8 + (right - left - 16) * 0.3;
  const send = (kind, x) => {
    const at = { bubbles: true, cancelable: true, clientX: x, clientY: y, button: 0, buttons: 1 };
    canvas.dispatchEvent(new PointerEvent(`pointer${kind}`, { ...at, pointerType: 'mouse', pointerId: 1, isPrimary: true }));
    canvas.dispatchEvent(new MouseEvent(`mouse${kind}`, at));
  };
  return new Promise((resolve) => {
    send('move', from);
    send('down', from);
    window.frames_.length = 0;
    let step = 0;
    const move = () => {
      step += 1;
      send('move', from + (step % 100) * 0.4);
      if (step < 150) return window.plainFrame(move);
      send('up', from + 20);
      return resolve(window.frames_.slice());
    };
    window.plainFrame(move);
  });
}

// The frames of a page that clears a canvas of the same size and does nothing else: what browser and driver take by themselves.
async function emptyFrames(browser) {
  const context = await browser.newContext({ viewport: { width: 1366, height: 768 } });
  const page = await context.newPage();
  await page.setContent('<body style="margin:0"><canvas id="window" width="1366" height="768" style="display:block"></canvas>');
  const at = await page.evaluate(() => new Promise((resolve) => {
    const gl = document.getElementById('window').getContext('webgl2', { alpha: false, antialias: false, depth: false });
    const times = [];
    const frame = () => {
      times.push(performance.now());
      gl.clearColor((times.length % 60) / 60, 0.5, 0.5, 1);
      gl.clear(gl.COLOR_BUFFER_BIT);
      if (times.length < 150) requestAnimationFrame(frame);
      else resolve(times);
    };
    requestAnimationFrame(frame);
  }));
  await context.close();
  return rounded(median(at.slice(1).map((time, i) => time - at[i])));
}

const launch = (...more) => chromium.launch({
  executablePath: process.env.CHROMIUM,
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', ...more],
});

// Frames of a drag where they do not wait for a screen.
async function frames(address, slider) {
  const browser = await launch('--disable-frame-rate-limit', '--disable-gpu-vsync');
  const context = await browser.newContext({ viewport: { width: 1366, height: 768 }, locale: 'en-GB' });
  const page = await opened(context, address);
  await page.waitForTimeout(3000);
  const dragged = told(await page.evaluate(dragInPage, slider));
  await context.close();
  const empty = await emptyFrames(browser);
  await browser.close();
  return { ...dragged, empty_page_interval_median_ms: empty };
}

// How long the page is blocked while it fits and finds intervals: the longest time between two chances to draw, the longest task, and the
// longest frame of the program without what browser and driver do besides. On a page that tells nothing and is asked nothing meanwhile.
async function blocked(browser, address) {
  const context = await browser.newContext({ viewport: { width: 1366, height: 768 }, locale: 'en-GB' });
  const page = await opened(context, address);
  // A worker has rehearsed by then.
  await page.waitForTimeout(4000);
  await page.evaluate(() => (window.longTasks.length = window.frames_.length = 0));
  const gap = page.evaluate(longestGap, 4000);
  await page.keyboard.press('F5');
  const longest = { gap_ms: Math.round(await gap) };
  const told = await page.evaluate(() => ({ tasks: window.longTasks.map((task) => task.duration), frames: window.frames_.map((frame) => frame.took) }));
  // Browsers tell of tasks from 50 ms on.
  longest.task_ms = told.tasks.length > 0 ? Math.round(Math.max(...told.tasks)) : 'under 50';
  longest.frame_ms = rounded(Math.max(...told.frames));
  const work = await until(page, (kept) => kept.fits.length === 1 && kept.fits[0].account?.intervals, 'a fit that is timed');
  longest.fit_ms = Math.round(work.fits[0].account.elapsed_ms);
  longest.intervals_ms = Math.round(work.fits[0].account.intervals.elapsed_ms);
  await context.close();
  return longest;
}

// The same without a screen.
async function blockedWithoutScreen(address) {
  const browser = await launch('--disable-frame-rate-limit', '--disable-gpu-vsync');
  const longest = await blocked(browser, address);
  await browser.close();
  return longest;
}

// How many pixels of the canvas are others than those of a whole frame.
async function pixelsApart(page) {
  await page.mouse.move(700, 760);
  await page.waitForTimeout(800);
  const read = (key) => page.evaluate((name) => {
    const gl = document.getElementById('window').getContext('webgl2');
    const bytes = new Uint8Array(4 * gl.canvas.width * gl.canvas.height);
    gl.readPixels(0, 0, gl.canvas.width, gl.canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    window[name] = new Uint32Array(bytes.buffer);
  }, key);
  await read('inParts');
  await page.evaluate(() => document.getElementById('window').dispatchEvent(new Event('webglcontextrestored')));
  await page.mouse.move(701, 760);
  await page.waitForTimeout(800);
  await read('whole');
  return page.evaluate(() => window.whole.filter((pixel, at) => pixel !== window.inParts[at]).length);
}

const shot = (page, name) => page.screenshot({ path: path.join(SHOTS, `${name}.png`) });

async function opened(context, address) {
  const page = await context.newPage();
  page.faults = [];
  page.on('pageerror', (error) => page.faults.push(`error: ${error.message}`));
  page.on('console', (message) => {
    if (message.type() === 'error') page.faults.push(`console: ${message.text()}`);
  });
  await page.addInitScript(watch);
  await page.goto(address);
  await page.waitForFunction(() => window.firstPicture, null, { timeout: 120000 });
  return page;
}

// Parameters and errors as the command line finds them.
function fitOfCommandLine(environment) {
  const options = { encoding: 'utf8', env: { ...process.env, ...environment } };
  return JSON.parse(execFileSync(process.env.PROGRAM, ['fit', EXAMPLE, '--json'], options));
}

async function main() {
  const { server, sent, origin } = await serve();
  const browser = await launch();
  const context = await browser.newContext({ viewport: { width: 1366, height: 768 }, locale: 'en-GB', acceptDownloads: true });
  await context.grantPermissions(['clipboard-read', 'clipboard-write'], { origin });
  const requests = [];
  context.on('request', (request) => requests.push(request.url()));
  const address = origin + FOLDER;

  console.log('first visit');
  let page = await opened(context, address);
  figures.transferred_bytes = sent.bytes;
  figures.first_picture_ms = Math.round(await page.evaluate(() => window.firstPicture));
  await page.waitForTimeout(1500);
  await shot(page, '1-first');
  check(page.faults.length === 0, `no error is reported ${page.faults}`);
  check(sent.bytes < 4e6, `first visit ${sent.bytes} bytes gzipped, under 4 MB`);

  console.log('a slider');
  await page.close();
  // Told apart from the page that is timed: telling takes time.
  page = await opened(context, `${address}?probe`);
  const slider = await widget(page, 'Slider', 'σ');
  const dragged = await drag(page, slider);
  const sigma = (await widget(page, 'Slider', 'σ')).number;
  check(sigma !== slider.number && dragged.frames > 10, `a drag moves σ from ${slider.number} to ${sigma}`);
  const moved = await until(page, (work) => JSON.stringify(work).includes(String(sigma)), 'the moved slider is kept');
  fs.writeFileSync(path.join(SHOTS, 'work.json'), JSON.stringify(moved, null, 1));
  check((await pixelsApart(page)) === 0, 'what is painted in parts is a whole frame');
  await shot(page, '2-slider');
  const timed = await opened(await browser.newContext({ viewport: { width: 1366, height: 768 }, locale: 'en-GB' }), address);
  await timed.waitForTimeout(1000);
  Object.assign(figures, { drag: await drag(timed, slider) });
  await timed.close();
  figures.frames_without_screen = await frames(address, slider);

  console.log('the fit');
  await page.keyboard.press('Control+z');
  await page.waitForTimeout(500);
  check((await widget(page, 'Slider', 'σ')).number === slider.number, 'undo puts σ back');
  figures.blocked_by_a_fit = { with_screen: await blocked(browser, address), without_screen: await blockedWithoutScreen(address) };
  const begun = Date.now();
  await page.keyboard.press('F5');
  const fitted = await until(page, (work) => work.fits.length === 1 && work.fits[0].account && work.fits[0].account.intervals, 'a fit with intervals', 120);
  figures.fit_until_kept_ms = Date.now() - begun;
  await shot(page, '3-fit');
  const account = fitted.fits[0].account;
  figures.fit_ms = Math.round(account.elapsed_ms);
  figures.intervals_ms = Math.round(account.intervals.elapsed_ms);
  fs.writeFileSync(path.join(SHOTS, 'fit.json'), JSON.stringify(fitted.fits[0], null, 1));
  compare(fitted.fits[0]);

  console.log('jobs beside the page');
  figures.longest_gaps_ms = {};
  for (const [name, words, seconds] of [['landscape', 'Landscape', 4], ['posterior', 'Draw from the posterior', 8]]) {
    await command(page, words);
    figures.longest_gaps_ms[name] = Math.round(await page.evaluate(longestGap, 1000 * seconds));
    await shot(page, `3-${name}`);
  }
  const drawn = await widget(page, 'Label', /^16000 draws of 27 values/, 240);
  check(drawn.label + drawn.value !== '', `draws came: ${drawn.value || drawn.label}`);
  await command(page, 'Keep refitting');
  await widget(page, 'Slider', 'σ');
  const before = (await widget(page, 'Slider', 'n')).number;
  const refits = page.evaluate(longestGap, 3000);
  await drag(page, await widget(page, 'Slider', 'σ'));
  figures.longest_gaps_ms.refit = Math.round(await refits);
  const end = Date.now() + 30000;
  while ((await widget(page, 'Slider', 'n')).number === before && Date.now() < end) await page.waitForTimeout(200);
  check((await widget(page, 'Slider', 'n')).number !== before, 'the others follow a slider that is dragged');
  await command(page, 'Keep refitting');
  check((await pixelsApart(page)) === 0, 'what is painted in parts is a whole frame, also of maps');
  // Figures are of panes on screen.
  await page.mouse.click(...middle(await widget(page, 'Button', 'DoLP')));
  await widget(page, 'Image', /^Plot: DoLP/);

  console.log('a file');
  await page.keyboard.press('Control+o');
  await page.waitForSelector('#files', { state: 'attached' });
  await page.setInputFiles('#files', { name: 'mine.csv', mimeType: 'text/csv', buffer: fs.readFileSync(EXAMPLE) });
  const added = await until(page, (work) => work.measurements.some((table) => table.name === 'mine.csv'), 'the file is open');
  check(added.measurements.some((table) => table.name === 'mine.csv'), 'a CSV is open');
  await shot(page, '4-file');

  console.log('a figure');
  const download = page.waitForEvent('download');
  await command(page, 'Plot DoLP as SVG');
  const file = await download;
  check(/dolp\.svg$/.test(file.suggestedFilename()), `a figure is downloaded: ${file.suggestedFilename()}`);
  check(fs.readFileSync(await file.path(), 'utf8').startsWith('<'), 'it is SVG');

  console.log('a lesson, and its link');
  await command(page, 'second Brewster angle');
  const title = (await widget(page, 'Label', /second Brewster angle sits/)).value;
  check(title !== '', `a lesson is open: ${title}`);
  await shot(page, '5-lesson');
  const lessonAngle = (await widget(page, 'Slider', 'n')).number;
  await command(page, 'Copy link');
  const link = await page.evaluate(() => navigator.clipboard.readText());
  check(link.startsWith(`${address}#pbrdf1.`), `a link of ${link.length} letters`);
  figures.lesson_link_letters = link.length;
  const second = await context.browser().newContext({ viewport: { width: 1366, height: 768 }, locale: 'en-GB' });
  second.on('request', (request) => requests.push(request.url()));
  const other = await opened(second, link.replace('#', '?probe#'));
  check((await widget(other, 'Label', /second Brewster angle sits/)).value === title, 'its link opens it in another browser');
  check((await widget(other, 'Slider', 'n')).number === lessonAngle, 'with its sliders');
  check((await other.evaluate(() => location.hash)) === '', 'the address holds no link any more: loading again shows the newest work');
  await shot(other, '6-link');
  check(other.faults.length === 0, `no error is reported ${other.faults}`);

  console.log('again');
  await page.close();
  page = await opened(context, address);
  await page.waitForTimeout(1500);
  check((await keptWork(page)).measurements.some((table) => table.name === 'mine.csv'), 'the work of before is kept');
  await shot(page, '7-again');

  console.log('small screens');
  for (const [name, width, height] of [['8-tablet', 1024, 768], ['9-phone', 844, 390]]) {
    const small = await browser.newContext({ viewport: { width, height }, hasTouch: true, isMobile: true, deviceScaleFactor: 2, locale: 'en-GB' });
    small.on('request', (request) => requests.push(request.url()));
    await byTouch(await opened(small, `${address}?probe`), name, width);
    await small.close();
  }

  console.log('embedded');
  const embedded = await opened(second, `${address}?probe&embed=dolp,lobes&lesson=02`);
  await widget(embedded, 'Image', /^Plot: DoLP/);
  await embedded.waitForTimeout(1500);
  const shown = await widgets(embedded);
  const plots = shown.filter((one) => one.role === 'Image' && one.label.startsWith('Plot:')).map((one) => one.label);
  check(plots.length >= 2 && plots.every((label) => /DoLP|BRDF/.test(label)), `an embedded page shows ${plots.join(' | ')}`);
  const rest = shown.filter((one) => one.role === 'Slider' || (one.role === 'Button' && /^(File|Fit|Edit)$/.test(one.label)));
  check(rest.length === 0, `and nothing else ${rest.map((one) => one.label)}`);
  const lesson = shown.some((one) => /Fresnel limit/.test(one.label + one.value));
  check(lesson, 'with its lesson');
  const kept = await embedded.evaluate(() => Object.keys(localStorage).join());
  await embedded.waitForTimeout(3000);
  check((await embedded.evaluate(() => Object.keys(localStorage).join())) === kept, 'it keeps nothing');
  await shot(embedded, '10-embedded');
  check(embedded.faults.length === 0, `no error is reported ${embedded.faults}`);

  console.log('requests');
  const foreign = requests.filter((url) => !url.startsWith(address) && !url.startsWith('data:') && !url.startsWith(`blob:${origin}`));
  check(foreign.length === 0, `${requests.length} requests, none elsewhere ${foreign}`);
  check(!requests.some((url) => url.includes('pbrdf1.') && !url.includes('#')), 'no link reaches a server');

  console.log(JSON.stringify(figures, null, 1));
  fs.writeFileSync(path.join(SHOTS, 'figures.json'), JSON.stringify(figures, null, 1));
  await browser.close();
  server.close();
  if (failures.length > 0) throw new Error(`does not hold:\n  ${failures.join('\n  ')}`);
}

// A finger moves a slider, two zoom a plot, one moves it, one that rests reads it, and a touch brings another pane to the front.
async function byTouch(page, name, width) {
  await page.waitForTimeout(1500);
  await shot(page, name);
  const canvas = await page.evaluate(() => [document.getElementById('window').width, window.innerWidth]);
  check(canvas[0] === 2 * canvas[1], `the canvas has the pixels of the screen: ${canvas}`);
  const plot = await widget(page, 'Image', /^Plot: DoLP/);
  // On a phone the sliders are beside it.
  const [wide, high] = [plot.place[2] - plot.place[0], plot.place[3] - plot.place[1]].map(Math.round);
  check(plot.place[2] <= width && wide > 0.4 * width && high > 150, `the plot has ${wide} × ${high} points`);
  const session = await page.context().newCDPSession(page);
  const touch = (type, ...points) =>
    session.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  const slider = await widget(page, 'Slider', 'σ');
  const [, y] = middle(slider);
  const [left, , right] = slider.place;
  const from = left + (right - left) * 0.65;
  await touch('touchStart', [from, y]);
  for (let step = 1; step <= 10; step += 1) await touch('touchMove', [from - step * 2, y]);
  await touch('touchEnd');
  await page.waitForTimeout(700);
  const sigma = (await widget(page, 'Slider', 'σ')).number;
  check(sigma !== slider.number, `a finger moves σ from ${slider.number} to ${sigma}`);

  const [x0, y0] = middle(plot);
  const looks = async (what) => {
    await page.waitForTimeout(700);
    return (await page.screenshot({ ...(what && { path: path.join(SHOTS, `${name}-${what}.png`) }) })).toString('base64');
  };
  const pictures = [await looks()];
  await touch('touchStart', [x0 - 30, y0], [x0 + 30, y0]);
  for (let step = 1; step <= 10; step += 1) await touch('touchMove', [x0 - 30 - 5 * step, y0], [x0 + 30 + 5 * step, y0]);
  await touch('touchEnd');
  pictures.push(await looks('pinch'));
  await touch('touchStart', [x0, y0]);
  for (let step = 1; step <= 10; step += 1) await touch('touchMove', [x0 - 6 * step, y0]);
  await touch('touchEnd');
  pictures.push(await looks('pan'));
  await touch('touchStart', [x0, y0]);
  await page.waitForTimeout(1000);
  pictures.push(await looks('read'));
  await touch('touchEnd');
  check(new Set(pictures).size === pictures.length, 'two fingers zoom a plot, one moves it, one that rests reads it');

  const tab = await widget(page, 'Button', 'Picture');
  const [x, at] = middle(tab);
  await touch('touchStart', [x, at]);
  await touch('touchEnd');
  await page.waitForTimeout(1500);
  check((await widgets(page)).every((one) => one.label !== plot.label), 'a touch brings another pane to the front');
  await shot(page, `${name}-tab`);

  // A lesson is chosen, read and left.
  const tap = async (label) => {
    let place = null;
    await comes(page, async () => (place = (await widgets(page)).find((one) => one.label.startsWith(label) && one.role !== 'Label')), label);
    await touch('touchStart', middle(place));
    await touch('touchEnd');
    await page.waitForTimeout(500);
  };
  await tap('Lessons');
  await tap('Where the second Brewster angle');
  await tap('Next step');
  await shot(page, `${name}-lesson`);
  check((await widgets(page)).some((one) => /Drag k slowly/.test(one.label + one.value)), 'a lesson is read');
  await tap('Close lesson');
  check(!(await widgets(page)).some((one) => one.label === 'Next step'), 'and left');
  check(page.faults.length === 0, `no error is reported ${page.faults}`);
}

// The largest relative difference of parameters and ends of intervals.
function difference(fit, told) {
  let worst = 0;
  let count = 0;
  const differ = (ours, theirs) => {
    if (ours === null && theirs === null) return;
    count += 1;
    const off = Math.abs(ours - theirs) / Math.max(Math.abs(theirs), 1e-300);
    worst = Math.max(worst, ours === theirs ? 0 : ours === null || theirs === null ? Infinity : off);
  };
  for (const [name, estimate] of Object.entries(told.parameters)) {
    differ(fit.parameters[name], estimate.value);
    const place = fit.free.indexOf(name);
    if (place < 0) continue;
    [estimate.interval68, estimate.interval95].forEach((interval, level) => {
      interval.forEach((end, side) => differ(fit.account.intervals.of[place][level][side], end));
    });
  }
  check(count > 20, `${count} numbers of the fit are compared`);
  return worst;
}

// The page has no fused multiply–add. A command line without it finds the same to 12 digits and more.
function compare(fit) {
  const portable = fitOfCommandLine({ PBRDF_INSTRUCTIONS: 'portable' });
  fs.writeFileSync(path.join(SHOTS, 'told.json'), JSON.stringify(portable, null, 1));
  figures.fit_off = difference(fit, portable);
  check(figures.fit_off < 1e-12, `the fit is that of the command line to 12 digits (off by ${figures.fit_off})`);
  figures.evaluations = [fit.account.evaluations, portable.evaluations];
  check(fit.account.evaluations === portable.evaluations, `found by the same ${fit.account.evaluations} evaluations`);
  // With it the search takes another way to the same minimum, where steps end that change no value by more than 1e-8.
  const fused = fitOfCommandLine({});
  const values = Object.entries(fused.parameters).map(([name, { value }]) => Math.abs(fit.parameters[name] - value) / Math.abs(value));
  figures.fit_off_fused = Math.max(...values);
  check(figures.fit_off_fused < 1e-8, `and with fused multiply–add to 8 (off by ${figures.fit_off_fused})`);
}

if (require.main === module) {
  main().catch((error) => {
    console.error(error);
    process.exit(1);
  });
}
module.exports = { blocked, serve, launch, opened, widget, widgets, command, drag, dragInPage, told, longestGap, shot, middle, median, FOLDER };
