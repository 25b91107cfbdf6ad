// Paints again only what has changed since the frame before. Where no graphics card draws, a frame costs by its triangles, and of
// twenty thousand a moved slider changes some hundreds.
//
// The program clears its canvas and draws meshes, one after the other, as if nothing had been there. Here the calls are held back until
// the last mesh of the frame, and compared with those of the frame before. Places where triangles differ are cleared and get all
// triangles that touch them, in their order: each pixel is what a whole frame would make it.

const WORDS = 5; // of a vertex: x, y in points, two of the texture, one colour
const MOST_PLACES = 12;
// Of the area of the canvas; of more, whole frames are painted.
const MOST_AREA = 0.7;
// Pixels between two changes that are painted as one.
const NEAR = 12;

const union = (a, b) => [Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.max(a[2], b[2]), Math.max(a[3], b[3])];
const meet = (a, b) => [Math.max(a[0], b[0]), Math.max(a[1], b[1]), Math.min(a[2], b[2]), Math.min(a[3], b[3])];
const isEmpty = ([left, top, right, bottom]) => left >= right || top >= bottom;
const area = ([left, top, right, bottom]) => (right - left) * (bottom - top);
const touch = (a, b, by) => a[0] <= b[2] + by && b[0] <= a[2] + by && a[1] <= b[3] + by && b[1] <= a[3] + by;

// Adds a place, in points; those that are near each other are one.
function add(places, place) {
  const at = places.findIndex((other) => touch(other, place, NEAR));
  if (at < 0 && places.length < MOST_PLACES) {
    places.push(place);
    return;
  }
  const [other] = places.splice(at < 0 ? places.length - 1 : at, 1);
  add(places, union(other, place));
}

// Memory that is used again, frame by frame: what is thrown away costs as much as what it saves.
let chosen = new Uint32Array(1 << 16);
let marks = new Uint8Array(1 << 14);

// Words that are kept, and the same as numbers.
class Room {
  constructor(length) {
    this.words = new Uint32Array(length);
    this.numbers = new Float32Array(this.words.buffer);
    this.length = 0;
  }

  take(bytes) {
    this.length = bytes.byteLength / 4;
    this.words.set(new Uint32Array(bytes.buffer, bytes.byteOffset, this.length));
  }
}

// A mesh as it was drawn: its vertices, their numbers by threes, its texture, and the pixels that it may touch.
class Mesh {
  constructor(vertices, indices, texture, scissor) {
    this.vertices = vertices;
    this.indices = indices;
    this.texture = texture;
    this.scissor = scissor;
  }

  // Adds where the triangles from the one to the other are: those of a word or a line follow each other, and are one place.
  placesOf(from, to, places) {
    const [indices, positions] = [this.indices.words, this.vertices.numbers];
    let [left, top, right, bottom] = [0, 0, 0, 0];
    for (let i = from; i < to; i += 3) {
      const a = WORDS * indices[i];
      const b = WORDS * indices[i + 1];
      const c = WORDS * indices[i + 2];
      const low = Math.min(positions[a], positions[b], positions[c]);
      const high = Math.max(positions[a], positions[b], positions[c]);
      const above = Math.min(positions[a + 1], positions[b + 1], positions[c + 1]);
      const below = Math.max(positions[a + 1], positions[b + 1], positions[c + 1]);
      const isNext = i > from && low <= right + NEAR && left <= high + NEAR && above <= bottom + NEAR && top <= below + NEAR;
      if (isNext) {
        left = Math.min(left, low);
        top = Math.min(top, above);
        right = Math.max(right, high);
        bottom = Math.max(bottom, below);
      } else {
        if (i > from) add(places, [left, top, right, bottom]);
        left = low;
        top = above;
        right = high;
        bottom = below;
      }
    }
    if (to > from) add(places, [left, top, right, bottom]);
  }

  // Adds where triangles show a part of their texture, in shares of its width and height.
  placesWith([left, top, right, bottom], places) {
    const [indices, numbers, length] = [this.indices.words, this.vertices.numbers, this.indices.length];
    for (let i = 0; i < length; i += 3) {
      const a = WORDS * indices[i] + 2;
      const b = WORDS * indices[i + 1] + 2;
      const c = WORDS * indices[i + 2] + 2;
      const isLeft = numbers[a] < left && numbers[b] < left && numbers[c] < left;
      const isRight = numbers[a] > right && numbers[b] > right && numbers[c] > right;
      const isAbove = numbers[a + 1] < top && numbers[b + 1] < top && numbers[c + 1] < top;
      const isBelow = numbers[a + 1] > bottom && numbers[b + 1] > bottom && numbers[c + 1] > bottom;
      if (!isLeft && !isRight && !isAbove && !isBelow) this.placesOf(i, i + 3, places);
    }
  }

  // Chooses the numbers of the triangles that touch a place in points; how many these are.
  within([left, top, right, bottom]) {
    const [indices, positions, length] = [this.indices.words, this.vertices.numbers, this.indices.length];
    let count = 0;
    if (chosen.length < length) chosen = new Uint32Array(2 * length);
    for (let i = 0; i < length; i += 3) {
      const a = WORDS * indices[i];
      const b = WORDS * indices[i + 1];
      const c = WORDS * indices[i + 2];
      const isLeft = positions[a] < left && positions[b] < left && positions[c] < left;
      const isRight = positions[a] > right && positions[b] > right && positions[c] > right;
      const isAbove = positions[a + 1] < top && positions[b + 1] < top && positions[c + 1] < top;
      const isBelow = positions[a + 1] > bottom && positions[b + 1] > bottom && positions[c + 1] > bottom;
      if (!isLeft && !isRight && !isAbove && !isBelow) {
        chosen[count] = indices[i];
        chosen[count + 1] = indices[i + 1];
        chosen[count + 2] = indices[i + 2];
        count += 3;
      }
    }
    return count;
  }
}

// Whether both have the same words.
function isSame(a, b) {
  if (a.length !== b.length) return false;
  const [ours, theirs, length] = [a.words, b.words, a.length];
  for (let i = 0; i < length; i += 1) if (ours[i] !== theirs[i]) return false;
  return true;
}

// Adds where two meshes of one texture and one scissor differ.
function differences(before, after, places) {
  const [v, w, i, j] = [before.vertices.words, after.vertices.words, before.indices.words, after.indices.words];
  const [ours, theirs] = [before.vertices.length, after.vertices.length];
  const [most, least] = [Math.max(before.indices.length, after.indices.length), Math.min(before.indices.length, after.indices.length)];
  if (ours === theirs && isSame(before.indices, after.indices)) {
    if (isSame(before.vertices, after.vertices)) return;
    const count = ours / WORDS;
    if (marks.length < count) marks = new Uint8Array(2 * count);
    for (let vertex = 0; vertex < count; vertex += 1) {
      const at = WORDS * vertex;
      const differs = v[at] !== w[at] || v[at + 1] !== w[at + 1] || v[at + 2] !== w[at + 2] || v[at + 3] !== w[at + 3] || v[at + 4] !== w[at + 4];
      marks[vertex] = differs ? 1 : 0;
    }
    for (let at = 0; at < most; at += 3) {
      if (marks[i[at]] || marks[i[at + 1]] || marks[i[at + 2]]) {
        before.placesOf(at, at + 3, places);
        after.placesOf(at, at + 3, places);
      }
    }
    return;
  }
  // What comes before and after the change is the same, but for the numbers of the vertices.
  let head = 0;
  const shorter = Math.min(ours, theirs);
  while (head < shorter && v[head] === w[head]) head += 1;
  let tail = 0;
  while (tail < shorter - head && v[ours - 1 - tail] === w[theirs - 1 - tail]) tail += 1;
  [head, tail] = [Math.floor(head / WORDS), Math.floor(tail / WORDS)];
  const shift = (theirs - ours) / WORDS;
  const last = ours / WORDS - tail;
  const [m, n] = [before.indices.length, after.indices.length];
  let from = 0;
  while (from < least && i[from] === j[from] && i[from] < head) from += 1;
  from -= from % 3;
  let to = 0;
  while (to < least - from && i[m - 1 - to] >= last && i[m - 1 - to] + shift === j[n - 1 - to]) to += 1;
  to -= to % 3;
  before.placesOf(from, m - to, places);
  after.placesOf(from, n - to, places);
}

// Lets a context of the program paint what has changed. It must keep what it has drawn (`preserveDrawingBuffer`).
export function repaintChanges(gl) {
  const plain = {};
  for (const name of ['bindBuffer', 'bindTexture', 'bindVertexArray', 'bufferData', 'clear', 'clearColor', 'drawElements', 'scissor', 'texImage2D',
    'texSubImage2D', 'uniform2f']) {
    plain[name] = gl[name].bind(gl);
  }
  let meshes = null; // of the frame that is being drawn
  let before = null; // of the one that is on the canvas
  let look = ''; // size, scale and ground of that
  let fresh = new Map(); // textures that are others than before, with the parts that are; without parts all of it
  const sizes = new WeakMap(); // of textures
  let points = [1, 1];
  let ground = '';
  let [vertices, indices, texture, scissor] = [null, null, null, null];

  // Rooms are kept until the frame after the next, and are then taken again in their order.
  let [spare, used, last] = [[], [], []];
  const keep = (bytes) => {
    let room = spare.pop();
    if (!room || room.words.length < bytes.byteLength / 4) room = new Room(Math.max(64, Math.ceil(0.375 * bytes.byteLength)));
    used.push(room);
    room.take(bytes);
    return room;
  };

  const paint = ([left, top, right, bottom], numbers, length) => {
    plain.scissor(left, top, right - left, bottom - top);
    plain.bufferData(gl.ELEMENT_ARRAY_BUFFER, numbers, gl.STREAM_DRAW, 0, length);
    plain.drawElements(gl.TRIANGLES, length, gl.UNSIGNED_INT, 0);
  };

  const send = ({ vertices: { words, length }, texture: to }) => {
    plain.bufferData(gl.ARRAY_BUFFER, words, gl.STREAM_DRAW, 0, length);
    plain.bindTexture(gl.TEXTURE_2D, to);
  };

  // Where the frame differs, in points; none where all of it may.
  const changes = () => {
    if (!before) return null;
    const places = [];
    const same = (a, b) => a.texture === b.texture && a.scissor.every((edge, at) => edge === b.scissor[at]);
    let head = 0;
    const least = Math.min(before.length, meshes.length);
    while (head < least && same(before[head], meshes[head])) head += 1;
    let tail = 0;
    while (tail < least - head && same(before[before.length - 1 - tail], meshes[meshes.length - 1 - tail])) tail += 1;
    const pair = (a, b) => {
      const own = [];
      const parts = fresh.get(b.texture);
      if (parts === null) {
        a.placesOf(0, a.indices.length, own);
        b.placesOf(0, b.indices.length, own);
      } else {
        // What showed a part and shows it no longer is a difference.
        (parts || []).forEach((part) => b.placesWith(part, own));
        differences(a, b, own);
      }
      own.map((place) => seen(place, b.scissor)).filter((place) => !isEmpty(place)).forEach((place) => add(places, place));
    };
    for (let at = 0; at < head; at += 1) pair(before[at], meshes[at]);
    for (let at = 1; at <= tail; at += 1) pair(before[before.length - at], meshes[meshes.length - at]);
    for (const [all, of] of [[before, before.length - tail], [meshes, meshes.length - tail]]) {
      for (const mesh of all.slice(head, of)) {
        const own = [];
        mesh.placesOf(0, mesh.indices.length, own);
        own.map((place) => seen(place, mesh.scissor)).filter((place) => !isEmpty(place)).forEach((place) => add(places, place));
      }
    }
    return places;
  };

  // Pixels to points, from the top, and back with all pixels that are touched.
  const scale = () => gl.canvas.width / points[0];
  const seen = (place, [x, y, width, height]) => {
    const by = scale();
    const top = gl.canvas.height - y - height;
    return meet(place, [x / by, top / by, (x + width) / by, (top + height) / by]);
  };
  const pixels = ([left, top, right, bottom]) => {
    const [by, high] = [scale(), gl.canvas.height];
    const place = [Math.floor(left * by) - 1, Math.floor(high - bottom * by) - 1, Math.ceil(right * by) + 1, Math.ceil(high - top * by) + 1];
    return meet(place, [0, 0, gl.canvas.width, high]);
  };

  const whole = () => {
    plain.scissor(0, 0, gl.canvas.width, gl.canvas.height);
    plain.clear(gl.COLOR_BUFFER_BIT);
    for (const mesh of meshes) {
      const [x, y, width, height] = mesh.scissor;
      send(mesh);
      if (mesh.indices.length > 0) paint([x, y, x + width, y + height], mesh.indices.words, mesh.indices.length);
    }
  };

  const parts = (places) => {
    for (const place of places) {
      plain.scissor(place[0], place[1], place[2] - place[0], place[3] - place[1]);
      plain.clear(gl.COLOR_BUFFER_BIT);
    }
    const [by, high] = [scale(), gl.canvas.height];
    for (const mesh of meshes) {
      const [x, y, width, height] = mesh.scissor;
      let isSent = false;
      for (const place of places) {
        const cut = meet(place, [x, y, x + width, y + height]);
        if (isEmpty(cut)) continue;
        // A pixel more, whatever is rounded.
        const count = mesh.within([(cut[0] - 1) / by, (high - cut[3] - 1) / by, (cut[2] + 1) / by, (high - cut[1] + 1) / by]);
        if (count === 0) continue;
        if (!isSent) send(mesh);
        isSent = true;
        paint(cut, chosen, count);
      }
    }
  };

  const finish = () => {
    const now = [gl.canvas.width, gl.canvas.height, points, ground].join();
    const found = now === look ? changes() : null;
    // Apart from each other, so that no pixel is painted twice.
    const places = [];
    for (let place of (found || []).map(pixels)) {
      for (let at = 0; at < places.length; at += 1) {
        if (!isEmpty(meet(places[at], place))) {
          place = union(places[at], place);
          places.splice(at, 1);
          at = -1;
        }
      }
      places.push(place);
    }
    const covered = places.reduce((sum, place) => sum + area(place), 0);
    if (!found || covered > MOST_AREA * gl.canvas.width * gl.canvas.height) whole();
    else parts(places);
    [before, look] = [meshes, now];
    [spare, last, used] = [last.reverse(), used, []];
    meshes = null;
    fresh = new Map();
  };

  gl.clearColor = (...color) => {
    ground = color.join();
    plain.clearColor(...color);
  };
  gl.clear = () => {
    meshes = [];
  };
  gl.uniform2f = (place, x, y) => {
    points = [x, y];
    plain.uniform2f(place, x, y);
  };
  gl.scissor = (...at) => {
    scissor = at;
  };
  gl.bindTexture = (target, to) => {
    texture = to;
    plain.bindTexture(target, to);
  };
  gl.texImage2D = (...what) => {
    const [, , , width, height] = what;
    sizes.set(texture, [width, height]);
    fresh.set(texture, null);
    plain.texImage2D(...what);
  };
  // Letters that are new come into room of the texture that was empty: what shows other letters stays.
  gl.texSubImage2D = (...what) => {
    const [, , x, y, width, height] = what;
    const [wide, high] = sizes.get(texture);
    const parts = fresh.has(texture) ? fresh.get(texture) : [];
    // A texel more, by which neighbours are smoothed.
    if (parts) fresh.set(texture, [...parts, [(x - 1) / wide, (y - 1) / high, (x + width + 1) / wide, (y + height + 1) / high]]);
    plain.texSubImage2D(...what);
  };
  gl.bufferData = (target, bytes, use) => {
    if (!meshes) return plain.bufferData(target, bytes, use);
    if (target === gl.ARRAY_BUFFER) vertices = keep(bytes);
    else indices = keep(bytes);
    return undefined;
  };
  gl.drawElements = () => {
    meshes.push(new Mesh(vertices, indices, texture, scissor));
  };
  // The program lets go of its vertices after the last mesh.
  gl.bindVertexArray = (to) => {
    if (!to && meshes) finish();
    plain.bindVertexArray(to);
  };
  // A canvas that has lost what was drawn is painted as a whole.
  gl.canvas.addEventListener('webglcontextrestored', () => {
    before = null;
  });
}
