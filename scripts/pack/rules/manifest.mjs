const versionPattern = /^\d+\.\d+\.\d+(-[0-9A-Za-z.-]+)?$/;

const fields = [
  ['name', (value) => /^[a-z0-9][a-z0-9._-]{0,213}$/.test(value), 'a reverse domain name in lower case'],
  ['version', (value) => versionPattern.test(value), 'a semantic version, for example 1.2.3'],
  ['displayName', (value) => value.length > 0, 'a name for people'],
  ['description', (value) => value.length > 0, 'a sentence or two'],
  ['unity', (value) => /^\d+\.\d+$/.test(value), 'the oldest Unity version, for example 2022.3'],
  ['license', (value) => value.length > 0, 'the name of a licence'],
];

/** package.json is valid for Unity's Package Manager: names, versions, dependencies, and samples that exist. */
export function checkManifest(files) {
  let manifest;
  try {
    manifest = JSON.parse(files.text('package.json'));
  } catch (error) {
    return [`package.json: ${files.has('package.json') ? error.message : 'is not there'}`];
  }
  const complaints = fields
    .filter(([key, isGood]) => typeof manifest[key] !== 'string' || !isGood(manifest[key]))
    .map(([key, , expected]) => `package.json: "${key}" is ${JSON.stringify(manifest[key])}; expected ${expected}`);
  for (const [name, version] of Object.entries(manifest.dependencies ?? {})) {
    if (!versionPattern.test(version)) {
      complaints.push(`package.json: dependency "${name}" is ${JSON.stringify(version)}; expected one version: Unity takes no ranges`);
    }
  }
  return [...complaints, ...checkSamples(manifest.samples ?? [], files)];
}

function checkSamples(samples, files) {
  const complaints = [];
  for (const [index, { displayName, description, path: place }] of samples.entries()) {
    const key = `package.json: samples[${index}]`;
    if (!displayName || !description) complaints.push(`${key}: expected "displayName" and "description"`);
    if (!files.folders.includes(place)) complaints.push(`${key}: no folder ${JSON.stringify(place)} in the package`);
  }
  const listed = new Set(samples.map(({ path: place }) => place));
  const unlisted = files.folders.filter((folder) => /^Samples~\/[^/]+$/.test(folder) && !listed.has(folder));
  return [...complaints, ...unlisted.map((folder) => `${folder}: is not among "samples" of package.json, so nobody can import it`)];
}
