// EnCodec's 24 kHz weights, which the published network works in. The name of the file states what its SHA-256 begins with.
import path from 'node:path';
import { CommandError } from '../lib/process.mjs';
import { cacheRoot } from './cache.mjs';
import { patientFetch, waitSeconds } from './requests.mjs';
import { bringFile } from './transfer.mjs';

const published = 'https://dl.fbaipublicfiles.com/encodec/v0/encodec_24khz-d7cc33bc.th';

/** The address of the weights: HAPTOFLOW_ENCODEC_URL for a mirror, whose file has the same form of name. */
export function encodecAddress(env = process.env) {
  const address = env.HAPTOFLOW_ENCODEC_URL || published;
  if (!/^https?:\/\/[^?#]+-[0-9a-f]{8}\.th$/.test(address)) {
    throw new CommandError(`HAPTOFLOW_ENCODEC_URL=${address}: expected an address that ends in -<8 digits of the file's SHA-256>.th, as ${path.posix.basename(published)} does`, 2);
  }
  return address;
}

/**
 * Brings the weights into the cache.
 * @returns {Promise<{place: string, address: string, sha256: string, size: number, isNew: boolean}>}
 */
export async function bringEncodec({ address = encodecAddress(), root = cacheRoot(), say = console.error, wait = waitSeconds, advance } = {}) {
  const name = path.posix.basename(new URL(address).pathname);
  const digest = { kind: 'sha256-start', digits: name.slice(-11, -3), source: 'its name' };
  const fetchPatiently = patientFetch({ say, wait });
  const ask = async (from) => {
    const response = await fetchPatiently(address, { headers: { Range: `bytes=${from}-`, 'Accept-Encoding': 'identity' } });
    if (!response.ok && response.status !== 416) {
      throw new CommandError(`${address} answers ${response.status}: HAPTOFLOW_ENCODEC_URL names another place of the file, or --encodec the file itself`);
    }
    return response;
  };
  const place = path.join(root, 'encodec', name);
  return { place, address, ...(await bringFile({ ask, place, size: null, digest, say, wait, advance })) };
}
