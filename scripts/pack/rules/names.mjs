export const longestPath = 100;

/** Windows' 260 characters have to hold the project's own path and Unity's cache folder as well. */
export function checkPathLengths(files) {
  return files.names
    .filter((name) => name.length > longestPath)
    .map((name) => `${name}: the path has ${name.length} characters; expected at most ${longestPath}`);
}

/** Names that differ in case only are one file on Windows and macOS. */
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
