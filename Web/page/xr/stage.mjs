import { Bench, geometryOf } from './bench.mjs';
import { boardTop, swatches, swatchMetres } from './board.mjs';
import { mirrorPosition, mirrorRotation } from './frames.mjs';
import { Looks } from './looks.mjs';
import { Panel, panelMetres } from './panel.mjs';
import { Pens } from './pens.mjs';

// Everything that is seen, by three.js.

const panelLeanRadians = 0.25;
const skyColour = 0x8a949d;
const deskThicknessMetres = 0.02;

function lightsOf(three) {
  const sun = new three.DirectionalLight(0xffffff, 1.8);
  sun.position.set(0.6, 2, 0.8);
  return [new three.HemisphereLight(0xffffff, 0x8a8f96, 1.6), sun];
}

function floorOf(three) {
  const floor = new three.Mesh(new three.PlaneGeometry(60, 60).rotateX(-Math.PI / 2), new three.MeshLambertMaterial({ color: 0x5a636c }));
  const grid = new three.GridHelper(16, 32, 0x6d7780, 0x6d7780);
  grid.position.y = 0.003;
  return [floor, grid];
}

/** Renderer and scene of one session. */
export class Stage {
  #three;
  #scene;
  #camera;
  #workbench;
  #foot;
  #bench;
  #pens;
  #looks;

  /**
   * @param {object} parts
   * @param {any} parts.three
   * @param {object} parts.scene SCENE.json, without the board
   * @param {import('../../engine/js/haptoflow.d.ts').Scene} parts.poses where its surfaces are
   * @param {{labels: Record<string, any>}} parts.looks
   * @param {Map<string, import('../table/reliefs.mjs').SurfaceRelief>} parts.reliefs by names of surfaces
   * @param {readonly string[]} parts.labels
   */
  constructor({ three, scene, poses, looks, reliefs, labels }) {
    this.#three = three;
    this.renderer = new three.WebGLRenderer({ antialias: true });
    this.renderer.xr.enabled = true;
    this.renderer.xr.setReferenceSpaceType('local-floor');
    // One looks at a tip from near by.
    this.#camera = new three.PerspectiveCamera(50, 1, 0.02, 60);
    this.#looks = new Looks(three, looks);
    const shadings = new Map([...reliefs].map(([name, relief]) => [name, this.#looks.shading(relief)]));
    this.#bench = new Bench({ three, scene, poses, looks: this.#looks, shadings });
    this.#pens = new Pens(three, 2);
    this.panel = new Panel(three);
    this.#workbench = new three.Group();
    this.#workbench.add(this.#bench.group, ...this.#boardOf(labels), this.panel.mesh);
    this.#placePanel(labels.length);
    this.#foot = new three.Mesh(new three.CylinderGeometry(0.03, 0.12, 1, 32), new three.MeshLambertMaterial({ color: 0x39424b }));
    this.#scene = new three.Scene();
    this.#scene.background = new three.Color(skyColour);
    this.#scene.fog = new three.Fog(skyColour, 2, 9);
    this.#scene.add(...lightsOf(three), ...floorOf(three), this.#workbench, this.#foot, this.#pens.group);
  }

  #boardOf(labels) {
    const three = this.#three;
    const [width, height, thickness] = swatchMetres;
    const edge = new three.MeshLambertMaterial({ color: 0x39424b });
    const face = new three.PlaneGeometry(width, height);
    return swatches(labels).map(({ name, shape, position, rotation, material }) => {
      const swatch = new three.Mesh(geometryOf(three, shape), edge);
      swatch.name = name;
      swatch.position.fromArray(mirrorPosition(position, [0, 0, 0]));
      swatch.quaternion.fromArray(mirrorRotation(rotation, [0, 0, 0, 1]));
      const front = new three.Mesh(face, this.#looks.caption(material, width / height));
      front.position.z = thickness / 2 + 0.0003;
      swatch.add(front);
      return swatch;
    });
  }

  #placePanel(labelCount) {
    const { mesh } = this.panel;
    mesh.position.fromArray(mirrorPosition(boardTop(labelCount), [0, 0, 0]));
    mesh.position.y += panelMetres.height / 2 + 0.02;
    mesh.rotation.x = -panelLeanRadians;
  }

  /** Puts the workbench where it stands in the room. @param {import('./frames.mjs').Placement} placement */
  place({ position, yaw }) {
    this.#workbench.position.fromArray(position);
    this.#workbench.rotation.y = yaw;
    const height = position[1] - deskThicknessMetres;
    this.#foot.scale.y = height;
    this.#foot.position.set(position[0], height / 2, position[2]);
  }

  paint(surface, label) {
    this.#bench.paint(surface, label);
  }

  /** Draws one frame. */
  render(timeSeconds, sides) {
    this.#bench.update(timeSeconds);
    this.#pens.update(sides);
    this.renderer.render(this.#scene, this.#camera);
  }

  close() {
    const seen = new Set();
    this.#scene.traverse(({ geometry, material }) => {
      if (geometry) seen.add(geometry);
      if (!material) return;
      seen.add(material);
      if (material.map) seen.add(material.map);
    });
    seen.forEach((each) => each.dispose());
    this.renderer.dispose();
    // Browsers allow few contexts at a time, and a collected one goes late.
    this.renderer.forceContextLoss();
  }
}
