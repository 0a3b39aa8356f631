/** Relative links of Markdown pages lead to files of the package, since the pages are also read there. */
export function checkLinks(files) {
  const complaints = [];
  for (const name of files.endingIn('.md')) {
    for (const [, target] of files.text(name).matchAll(/\]\(<?([^)>#\s][^)>#]*?)>?(?:#[^)]*)?\)/g)) {
      if (/^[a-z]+:/.test(target)) continue;
      const place = resolved(name, target);
      if (place === null || !(files.has(place) || files.folders.includes(place))) {
        complaints.push(`${name}: links to ${target}, which is not in the package`);
      }
    }
  }
  return complaints;
}

/** The target of a relative link; null for a target outside the package. */
function resolved(name, target) {
  const pieces = name.split('/').slice(0, -1);
  for (const piece of decodeURI(target).replace(/\/$/, '').split('/')) {
    if (piece === '..' && pieces.pop() === undefined) return null;
    if (piece !== '..' && piece !== '.') pieces.push(piece);
  }
  return pieces.join('/');
}
