// A model file that somebody gave the page: it stays on the device, and the page begins with it until it is given back.

const cacheName = 'haptoflow-model';
const place = 'given.haptoflow';
const nameHeader = 'X-File-Name';
const magic = 'HAPTFLOW';

const addressOf = () => new URL(place, location.href).href;

const storage = async () => {
  try {
    return await caches.open(cacheName);
  } catch (error) {
    throw new Error(`this browser keeps no files for this page, which a model needs (${/** @type {Error} */ (error).message})`);
  }
};

export const isModel = (/** @type {string} */ name) => /\.haptoflow$/i.test(name);

/** The file that was given, if one was. @returns {Promise<{name: string, bytes: Uint8Array} | null>} */
export async function keptModel() {
  try {
    const found = await (await storage()).match(addressOf());
    if (!found) return null;
    return { name: decodeURIComponent(found.headers.get(nameHeader) ?? place), bytes: new Uint8Array(await found.arrayBuffer()) };
  } catch {
    // A browser without storage has nothing kept.
    return null;
  }
}

/** Keeps the file for the page's next start. @param {File} file @throws {Error} whose message says why it is not kept */
export async function keepModel(file) {
  const head = await file.slice(0, magic.length).text();
  if (head !== magic) throw new Error(`${file.name} is no .haptoflow file: it does not begin with ${magic}`);
  const headers = { [nameHeader]: encodeURIComponent(file.name), 'Content-Type': 'application/octet-stream' };
  await (await storage()).put(addressOf(), new Response(file, { headers }));
}

export async function forgetModel() {
  await (await storage()).delete(addressOf());
}

/**
 * The scene with materials that the model has: a name that it lacks becomes one of its own, the same for each object that has
 * the name. Returns the names that it lacks.
 * @param {any} scene @param {readonly {name: string}[]} labels
 */
export function fittedTo(scene, labels) {
  const own = new Set(labels.map(({ name }) => name));
  const lacking = [...new Set(scene.surfaces.map((/** @type {any} */ { material }) => material))].filter((name) => !own.has(/** @type {string} */ (name)));
  const taken = new Set(scene.surfaces.map((/** @type {any} */ { material }) => material));
  const free = labels.map(({ name }) => name).filter((name) => !taken.has(name));
  const source = free.length > 0 ? free : [...own];
  // Spread over all labels: neighbours in the list are often alike.
  const instead = new Map(lacking.map((name, index) => [name, source[Math.floor((index * source.length) / lacking.length)]]));
  const surfaces = scene.surfaces.map((/** @type {any} */ surface) => ({ ...surface, material: instead.get(surface.material) ?? surface.material }));
  return { scene: { ...scene, surfaces }, lacking };
}

/**
 * The qualities that differ in a model, as the engine finds their tiers: by their names, or the first and the last.
 * @param {readonly {name: string}[]} tiers @returns {{quality: 'sketch' | 'draft' | 'standard', tier: string}[]}
 */
export function qualitiesOf(tiers) {
  const named = (/** @type {string} */ name, /** @type {number} */ otherwise) => tiers.find((tier) => tier.name === name)?.name ?? tiers.at(otherwise)?.name ?? '';
  const all = /** @type {const} */ ([['sketch', 0], ['draft', 0], ['standard', -1]]);
  return all.map(([quality, otherwise]) => ({ quality, tier: named(quality, otherwise) })).filter(({ tier }, index, found) => found.findIndex((other) => other.tier === tier) === index);
}
