/** The SHA-256 that a page names; null where it names none. Throws RangeError where it names two. */
export function modelOfPage(text) {
  const named = new Set([...text.matchAll(/^Model: SHA-256 `([0-9a-f]{64})`\.$/gm)].map(([, sha256]) => sha256));
  if (named.size > 1) throw new RangeError(`the page names ${named.size} models`);
  return [...named][0] ?? null;
}
