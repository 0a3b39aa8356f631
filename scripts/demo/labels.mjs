const colours = {
  wood: '#b9793f', plywood: '#d8b483', stone: '#7d8590', concrete: '#9a9a94', brick: '#b4533c', ceramic: '#c9b8a8',
  glass: '#6fb7c4', metal: '#8fa3b8', 'metal mesh': '#5b7fb5', plastic: '#d46fa0', rubber: '#5d5566', leather: '#8a4b2d',
  cotton: '#a9b7e0', corduroy: '#8f5fa8', jute: '#b59a4c', fur: '#c98f6b', paper: '#d9d2b0', cardboard: '#b08d62',
  sandpaper: '#d98e2b', carpet: '#5f8f5a',
};

/** The colour of a label in every drawing. Labels that the shipped model does not have share one colour. */
export const colourOfLabel = (label) => colours[label] ?? '#7a7a7a';

/** Label names of a surface's material (a name, or weights by name), strongest first. */
export function labelsOf(material) {
  if (typeof material === 'string') return [material];
  return Object.entries(material).sort(([, a], [, b]) => b - a).map(([label]) => label);
}

/** Text made safe for HTML and SVG, in content and in attributes. */
export const escapeMarkup = (text) =>
  String(text).replace(/[&<>"']/g, (sign) => ({ '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;', "'": '&#39;' })[sign]);

/** "metal mesh" -> "metal-mesh": for file names and anchors. */
export const slug = (name) => name.toLowerCase().replace(/[^a-z0-9]+/g, '-').replace(/^-|-$/g, '');
