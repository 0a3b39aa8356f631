import { LabelIndices } from '../../../Web/engine/js/contact-fields.mjs';
import { Scene } from '../../../Web/engine/js/scene.mjs';
import { coreWithModel, pageCore } from './engine.mjs';

/** Opens scenes with the shipped model's labels, as a page does. */
export async function sceneOpener() {
  const { labels } = (await coreWithModel()).json('hapto_model_json');
  const indices = new LabelIndices();
  indices.set(labels);
  const core = pageCore();
  return { labels, open: (/** @type {string | object} */ scene) => new Scene(core, indices, labels, scene) };
}
