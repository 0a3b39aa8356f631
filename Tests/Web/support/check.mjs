import { HaptoFlow } from '../engine/haptoflow.mjs';
import { pause } from '../engine/pause.mjs';

// Checks engine and live page in a browser that the tests cannot drive, and posts the results to the server of this page.

const loudest = (wave) => wave.reduce((most, sample) => Math.max(most, Math.abs(sample)), 0);

async function until(holds, seconds, what) {
  for (const end = performance.now() + 1000 * seconds; performance.now() < end; await pause(20)) if (holds()) return;
  throw new Error(`${what}: not within ${seconds} s`);
}

/** The command line's render, as the test has it. */
async function rendered() {
  const { scene, stroke } = await (await fetch('/task.json')).json();
  const found = {};
  for (const quality of ['sketch', 'draft', 'standard']) {
    const { samples } = await HaptoFlow.render({ scene, stroke, quality });
    found[quality] = Array.from(samples);
  }
  return found;
}

async function slid() {
  const haptics = await HaptoFlow.create();
  await Promise.race([haptics.resume(), pause(2000)]);
  const voice = await haptics.openVoice();
  const events = [];
  for (const type of ['error', 'recovered']) haptics.addEventListener(type, ({ detail }) => events.push(`${type} ${detail.error?.message ?? detail.reason}`));
  const tap = voice.waveTap();
  const motor = voice.motorTap();
  const slide = async (seconds) => {
    for (const began = performance.now(); performance.now() - began < 1000 * seconds; await pause(8)) {
      const now = performance.now() / 1000;
      voice.publish({ touching: true, material: 'wood', velocityMps: [0.12 + 0.06 * Math.sin(7 * now), 0.02], forceNewtons: 1 });
    }
  };
  const wave = new Float32Array(9600);
  await slide(2);
  tap.latest(wave);
  const first = { peak: loudest(wave), motor: motor.peak(), voice: voice.statistics(), engine: haptics.statistics() };
  voice.lift();
  await pause(400);
  tap.latest(wave);
  const quiet = loudest(wave.subarray(wave.length - 4800));
  haptics[Symbol.for('haptoflow.worker')].terminate();
  await until(() => events.some((event) => event.startsWith('recovered')), 20, 'a recovery');
  await slide(1);
  tap.latest(wave);
  const result = { ...first, quiet, again: loudest(wave), events, state: haptics.context.state };
  await haptics.close();
  return result;
}

/** The live page, under a preset stroke. */
async function drawn() {
  const frame = document.createElement('iframe');
  frame.width = '1200';
  frame.height = '760';
  frame.allow = 'autoplay';
  frame.src = '/somewhere/index.html';
  document.body.append(frame);
  const inner = () => frame.contentWindow;
  await until(() => inner()?.haptoflowPage, 30, 'the live page');
  const complaints = [];
  inner().addEventListener('error', ({ message }) => complaints.push(message));
  const { haptics, hand, tips, scope } = inner().haptoflowPage;
  const heard = new Set();
  let peak = 0;
  const timer = setInterval(() => {
    if (tips[0].contact?.touching) heard.add(tips[0].contact.surfaceName);
    peak = Math.max(peak, scope.rmsMps2);
  }, 10);
  const legs = [[-0.15, -0.112], [-0.09, -0.112], [-0.03, -0.112]].map((to) => ({ to, seconds: 0.7 }));
  const isComplete = await hand.play({ name: '', words: '', from: [-0.22, -0.112], legs });
  clearInterval(timer);
  return { isComplete, heard: [...heard], rmsMps2: peak, complaints, error: inner().document.querySelector('#message').dataset.kind === 'error' ? inner().document.querySelector('#message-text').textContent : '', start: inner().document.querySelector('#start').hidden, statistics: haptics.statistics() };
}

const found = { userAgent: navigator.userAgent, isIsolated: globalThis.crossOriginIsolated === true, failures: [] };
for (const [name, action] of Object.entries({ rendered, slid, drawn })) {
  try {
    found[name] = await action();
  } catch (error) {
    found.failures.push(`${name}: ${error.code ?? ''} ${error.message}\n${error.stack}`);
  }
}
await fetch('/report', { method: 'POST', body: JSON.stringify(found) });
