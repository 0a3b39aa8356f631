export const longestPath = 100;

/** The maximum length of a path in the package: the limit of 260 characters of Windows includes project path and cache folder. */
export function checkPathLengths(files) {
  return files.names
    .filter((name) => name.length > longestPath)
    .map((name) => `${name}: the path has ${name.length} characters; expected at most ${longestPath}`);
}

/** No two names differ in case only: on Windows and macOS they would be the same file. */
export function checkCase(files) {
  const seen = new Map();
  const complaints = [];
  for (const name of [...files.folders, ...files.names]) {
    const other = seen.get(name.toLowerCase());
    if (other) complaints.push(`${name}: differs from ${other} in upper and lower case only`);
    seen.set(name.toLowerCase(), name);
  }
  return complaints;
}
