// Runs jobs beside the page. The first message is the compiled program, which then takes the messages itself.
import init from './pbrdf-explorer.js';

addEventListener('message', (event) => init({ module_or_path: event.data }), { once: true });
