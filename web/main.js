// Loads the program with a bar, and says in a sentence where it cannot run.
import init from './pbrdf-explorer.js';
import { repaintChanges } from './repaint.js';

const PROGRAM = './pbrdf-explorer_bg.wasm';
// Its size as build.sh found it: a server that compresses does not tell.
const BYTES = Number('@BYTES@');

const chinese = navigator.language.startsWith('zh');
const SENTENCES = {
  webgl: chinese
    ? '此页面需要 WebGL 2：请在浏览器设置中启用硬件加速，或换用较新的浏览器。'
    : 'This page needs WebGL 2: switch on hardware acceleration in the settings of the browser, or use a newer browser.',
  wasm: chinese
    ? '此页面需要 WebAssembly：请换用较新的浏览器。'
    : 'This page needs WebAssembly: use a newer browser.',
  load: chinese
    ? '程序无法载入：请检查网络连接并重新载入此页面。'
    : 'The program cannot be loaded: check the connection and load this page again.',
};

function refuse(sentence) {
  const loading = document.getElementById('loading');
  if (loading) {
    loading.textContent = sentence;
    loading.setAttribute('role', 'alert');
  }
}

// The answer of the server, which moves the bar while it comes.
function watched(response) {
  const bar = document.getElementById('progress');
  const reader = response.body.getReader();
  let done = 0;
  const body = new ReadableStream({
    async pull(controller) {
      const part = await reader.read();
      if (part.done) {
        controller.close();
        return;
      }
      done += part.value.length;
      if (bar) bar.value = Math.min(1, done / BYTES);
      controller.enqueue(part.value);
    },
  });
  return new Response(body, { headers: { 'Content-Type': 'application/wasm' } });
}

// Tools that imitate a smaller device tell its size in pixels of the screen that they run on. Where that is so, the program takes the size
// in the units of the page, times their scale. This observer is older than the program's, and so is asked first.
function measureAsImitated(canvas) {
  const observer = new ResizeObserver(([entry]) => {
    observer.disconnect();
    const told = entry.devicePixelContentBoxSize?.[0].inlineSize;
    const meant = canvas.clientWidth * devicePixelRatio;
    // A pixel is lost by rounding.
    if (told !== undefined && Math.abs(told - meant) > 2) delete ResizeObserverEntry.prototype.devicePixelContentBoxSize;
  });
  observer.observe(canvas);
}

async function start() {
  if (typeof WebAssembly !== 'object') return refuse(SENTENCES.wasm);
  const canvas = document.getElementById('window');
  // The program finds this context at the canvas. Its triangles have soft edges of their own, in one plane before an opaque ground.
  const context = { alpha: false, antialias: false, depth: false, stencil: false, preserveDrawingBuffer: true };
  const gl = canvas.getContext('webgl2', context);
  if (!gl) return refuse(SENTENCES.webgl);
  if (gl.getContextAttributes()?.preserveDrawingBuffer) repaintChanges(gl);
  measureAsImitated(canvas);
  try {
    const response = await fetch(PROGRAM);
    if (!response.ok) throw new Error(`${PROGRAM}: ${response.status}`);
    await init({ module_or_path: await WebAssembly.compileStreaming(watched(response)) });
  } catch (error) {
    console.error(error);
    refuse(SENTENCES.load);
  }
}

start();
