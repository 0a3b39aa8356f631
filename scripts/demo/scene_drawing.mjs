import { outline, positionAt, restPose } from './geometry.mjs';
import { colourOfLabel, escapeMarkup, labelsOf } from './labels.mjs';

const pixelsPerMetre = 1000;
const marginMetres = 0.05;
const trackRateHz = 30;

/** The two views: the world axes that point right and up, and the axis along which far objects are drawn before near ones. */
const views = [
  { name: 'top', caption: 'Seen from above', right: 0, up: 2, depth: (position) => position[1] },
  { name: 'side', caption: 'Seen from the front', right: 0, up: 1, depth: (position) => -position[2] },
];

/**
 * The scene and the stroke as two SVG pictures.
 * @param {object} scene parsed SCENE.json
 * @param {{timeSeconds: number, position: number[], touching: boolean}[]} path the stroke with what it touched
 * @returns {string[]} markup, from above and from the front; the elements of class "tip" and "mover" carry data-track, 30 places a second, for the player
 */
export const drawScene = (scene, path) => views.map((view) => drawView(view, scene, path));

function drawView(view, scene, path) {
  const project = (position) => [position[view.right], position[view.up]];
  const frame = frameAround(view, scene, path, project);
  const toPicture = ([x, y]) => [
    Math.round((x - frame.left) * pixelsPerMetre * 10) / 10,
    Math.round((frame.top - y) * pixelsPerMetre * 10) / 10,
  ];
  const ordered = [...scene.surfaces].sort((a, b) => view.depth(restPose(a).position) - view.depth(restPose(b).position));
  const planes = ordered.filter((surface) => surface.shape.plane);
  const solids = ordered.filter((surface) => !surface.shape.plane);
  const drawnPlanes = planes.map((plane) => drawPlane(view, plane, frame, toPicture)).join('');
  const drawnSolids = solids.map((surface) => drawSolid(surface, project, toPicture, path.at(-1).timeSeconds)).join('');
  const layers = view.name === 'top' ? drawnPlanes + drawnSolids : drawnSolids + drawnPlanes;
  // The front view has no names: nearer objects would cover them. Colours identify the objects.
  const names = view.name === 'top' ? solids.map((surface) => nameOf(surface, project, toPicture)).join('') : '';
  const title = `${view.caption}: ${scene.surfaces.map((surface) => `${surface.name} (${labelsOf(surface.material).join(' and ')})`).join(', ')}`;
  return `<figure class="view"><svg viewBox="0 0 ${frame.width} ${frame.height}" role="img" aria-label="${escapeMarkup(title)}">
${layers}${drawPath(path, project, toPicture)}${names}</svg><figcaption>${view.caption}</figcaption></figure>`;
}

function frameAround(view, scene, path, project) {
  const outlines = scene.surfaces.map((surface) => outline(surface, project)).filter(Boolean);
  const points = [...outlines.flat(), ...path.map(({ position }) => project(position))];
  const [left, right] = [Math.min, Math.max].map((pick, side) => pick(...points.map(([x]) => x)) + (side ? 1 : -1) * marginMetres);
  const top = Math.max(...points.map(([, y]) => y)) + marginMetres;
  const floor = scene.surfaces.filter((surface) => surface.shape.plane).map((plane) => restPose(plane).position[1]);
  // In the front view the table covers everything below it.
  const lowest = view.name === 'side' && floor.length > 0 ? Math.min(...floor) : Math.min(...points.map(([, y]) => y));
  const bottom = lowest - marginMetres;
  return { left, top, width: Math.round((right - left) * pixelsPerMetre), height: Math.round((top - bottom) * pixelsPerMetre) };
}

function drawPlane(view, plane, frame, toPicture) {
  const [label] = labelsOf(plane.material);
  const top = view.name === 'top' ? 0 : toPicture([0, restPose(plane).position[1]])[1];
  const text = `<text class="name" x="14" y="${frame.height - 14}">${escapeMarkup(plane.name)}: ${escapeMarkup(label)}</text>`;
  return `<g><title>${escapeMarkup(plane.name)}: ${escapeMarkup(label)}</title>
<rect class="${view.name === 'top' ? 'ground' : 'table'}" x="0" y="${top}" width="${frame.width}" height="${frame.height - top}" fill="${colourOfLabel(label)}"/>${view.name === 'top' ? text : ''}</g>\n`;
}

function drawSolid(surface, project, toPicture, seconds) {
  const labels = labelsOf(surface.material);
  const corners = outline(surface, project).map(toPicture);
  let track = '';
  if (surface.motion) {
    const [restX, restY] = toPicture(project(restPose(surface).position));
    const places = Array.from({ length: Math.ceil(seconds * trackRateHz) + 1 }, (_, step) => {
      const [x, y] = toPicture(project(positionAt(surface, step / trackRateHz)));
      return [Math.round((x - restX) * 10) / 10, Math.round((y - restY) * 10) / 10];
    });
    track = ` class="mover" data-track="${escapeMarkup(JSON.stringify(places))}"`;
  }
  return `<g${track}><title>${escapeMarkup(surface.name)}: ${escapeMarkup(labels.join(' and '))}</title>
<polygon class="solid" points="${corners.map((corner) => corner.join(',')).join(' ')}" fill="${colourOfLabel(labels[0])}"/></g>\n`;
}

function nameOf(surface, project, toPicture) {
  const corners = outline(surface, project).map(toPicture);
  const [low, high] = [Math.min, Math.max].map((pick) => [0, 1].map((axis) => pick(...corners.map((corner) => corner[axis]))));
  const text = escapeMarkup(labelsOf(surface.material).join(' + '));
  return `<text class="name" text-anchor="middle" x="${(low[0] + high[0]) / 2}" y="${low[1] + 0.18 * (high[1] - low[1]) + 8}">${text}</text>\n`;
}

function drawPath(path, project, toPicture) {
  const runs = [];
  for (const sample of path) {
    if (runs.at(-1)?.touching !== sample.touching) {
      const joint = runs.at(-1)?.points.at(-1);
      runs.push({ touching: sample.touching, points: joint ? [joint] : [] });
    }
    runs.at(-1).points.push(toPicture(project(sample.position)));
  }
  const lines = runs.map(({ touching, points }) => `<polyline class="${touching ? 'touching' : 'free'}" points="${points.map((point) => point.join(',')).join(' ')}"/>`);
  const [x, y] = toPicture(project(path[0].position));
  const places = resampled(path).map((position) => toPicture(project(position)));
  return `${lines.join('\n')}
<circle class="start" cx="${x}" cy="${y}" r="11"/><text class="name" text-anchor="middle" x="${x}" y="${y + 38}">start</text>
<circle class="tip" cx="${x}" cy="${y}" r="13" data-track="${escapeMarkup(JSON.stringify(places))}"/>`;
}

function resampled(path) {
  const count = Math.ceil((path.at(-1).timeSeconds - path[0].timeSeconds) * trackRateHz) + 1;
  let next = 0;
  return Array.from({ length: count }, (_, step) => {
    const time = path[0].timeSeconds + step / trackRateHz;
    while (next < path.length - 1 && path[next].timeSeconds < time) next += 1;
    return path[next].position;
  });
}
