// Requests that wait where a server asks to, and errors of a network that say what to do.
import { setTimeout as pause } from 'node:timers/promises';
import { CommandError } from '../lib/process.mjs';

/** How often a request is made, or a download goes on, before the user hears of it. */
export const tries = 5;
// The hub counts requests over five minutes: who has to wait longer is blocked for another reason.
const longestWaitSeconds = 300;

/** A server that cannot be reached, or that left in the middle. */
export class NetworkError extends CommandError {
  /** @param {string} message @param {string} [reason] the system's word for it */
  constructor(message, reason) {
    super(message);
    this.reason = reason;
  }
}

/** Waits some seconds. Tests hand in one that only notes them. */
export const waitSeconds = (seconds) => pause(1000 * seconds);

/** Seconds before the try after try number `attempt`. */
export const backOffSeconds = (attempt) => 2 ** (attempt - 1);

/**
 * The seconds that an answer asks to wait: Retry-After (seconds or a date), else the `t` of the hub's RateLimit header.
 * @returns {number | null}
 */
export function askedWaitSeconds(headers, now = Date.now()) {
  const after = headers.get('retry-after');
  if (after !== null) {
    const seconds = /^\s*\d+\s*$/.test(after) ? Number(after) : (Date.parse(after) - now) / 1000;
    if (Number.isFinite(seconds)) return Math.max(0, Math.ceil(seconds));
  }
  const reset = headers.get('ratelimit')?.match(/;\s*t=(\d+)/);
  return reset ? Number(reset[1]) : null;
}

/**
 * A `fetch` that waits and asks again where a server is asked too often (429) or has no time (502, 503, 504).
 * @param {{say: (line: string) => void, wait?: (seconds: number) => Promise<void>}} options
 * @throws NetworkError; CommandError after the last 429. Other answers are returned, whatever their status.
 */
export function patientFetch({ say, wait = waitSeconds }) {
  return async (address, options) => {
    for (let attempt = 1; ; attempt += 1) {
      const response = await fetchOrFail(address, options);
      if (![429, 502, 503, 504].includes(response.status)) return response;
      await response.body?.cancel();
      const seconds = askedWaitSeconds(response.headers) ?? backOffSeconds(attempt);
      const { host } = new URL(address);
      const complaint = response.status === 429 ? `${host} answers fewer requests (429)` : `${host} is not in service (${response.status})`;
      if (attempt === tries || seconds > longestWaitSeconds) {
        throw new CommandError(`${complaint}${attempt === tries ? `, ${tries} times in a row` : ` and asks to wait ${seconds} s`}: run again later; what is downloaded stays`);
      }
      say(`${complaint}: waiting ${seconds} s`);
      await wait(seconds);
    }
  };
}

async function fetchOrFail(address, options) {
  try {
    return await fetch(address, options);
  } catch (error) {
    throw networkError(address, error);
  }
}

/** Whether an error is that of a connection which ended while its answer was read (Node calls it "terminated"), or before. */
export const isCut = (error) => (error instanceof TypeError && error.message === 'terminated') || ['ECONNRESET', 'EPIPE', 'UND_ERR_SOCKET'].includes(error.reason);

/** What a connection's error says below the words "fetch failed". */
export function reasonOf(error) {
  const cause = error.cause?.errors?.[0] ?? error.cause ?? error;
  return error.reason ?? cause.code ?? cause.message;
}

/** The error of a connection, with a remedy. */
export function networkError(address, error, env = process.env, node = process.versions.node) {
  const { origin } = new URL(address);
  const proxies = ['HTTPS_PROXY', 'https_proxy', 'HTTP_PROXY', 'http_proxy'].filter((name) => env[name]);
  const state = proxies.length > 0 ? `${proxies.join(', ')} ${proxies.length > 1 ? 'are' : 'is'} set` : 'HTTPS_PROXY is not set';
  return new NetworkError(
    `${origin} cannot be reached (${reasonOf(error)}): check the network. Behind a proxy (${state}), Node 22.21 or newer uses it with ` +
      `NODE_USE_ENV_PROXY=1 (this is ${node}), and NODE_EXTRA_CA_CERTS names a certificate of its own; HF_ENDPOINT names a mirror of the hub. ` +
      'Files that a browser downloaded do as well: ./run published FOLDER',
    reasonOf(error),
  );
}
