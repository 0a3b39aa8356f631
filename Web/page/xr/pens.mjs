// What shows where each hand's tip is.

const tipLengthMetres = 0.018;
const bodyLengthMetres = 0.11;
const radiusMetres = 0.0045;
const rest = 0xd5dadf;
const touching = 0xf0c987;

/** A pen whose tip is the origin and points along -z; for a finger, a ball about it. */
class Pen {
  constructor(three) {
    this.group = new three.Group();
    this.group.visible = false;
    this.material = new three.MeshLambertMaterial({ color: rest });
    const cone = new three.Mesh(new three.ConeGeometry(radiusMetres, tipLengthMetres, 24), this.material);
    cone.rotation.x = -Math.PI / 2;
    cone.position.z = tipLengthMetres / 2;
    const barrel = new three.CylinderGeometry(radiusMetres, radiusMetres, bodyLengthMetres, 24);
    const body = new three.Mesh(barrel, new three.MeshLambertMaterial({ color: 0x39424b }));
    body.rotation.x = Math.PI / 2;
    body.position.z = tipLengthMetres + bodyLengthMetres / 2;
    this.ball = new three.Mesh(new three.SphereGeometry(0.006, 24, 16), this.material);
    this.stick = new three.Group();
    this.stick.add(cone, body);
    this.group.add(this.stick, this.ball);
  }

  update({ isTracked, profile, position, orientation, hand }) {
    this.group.visible = isTracked;
    if (!isTracked) return;
    const isFinger = profile.joint !== undefined;
    this.stick.visible = !isFinger;
    this.ball.visible = isFinger;
    this.group.position.fromArray(position);
    this.group.quaternion.fromArray(orientation);
    this.material.color.setHex(hand.contact === null ? rest : touching);
  }
}

/** The pens of both hands. */
export class Pens {
  #pens;

  constructor(three, count) {
    this.#pens = Array.from({ length: count }, () => new Pen(three));
    this.group = new three.Group();
    this.group.add(...this.#pens.map(({ group }) => group));
  }

  /** @param {readonly any[]} sides of `Hands` */
  update(sides) {
    for (let index = 0; index < sides.length; index += 1) this.#pens[index].update(sides[index]);
  }
}
