import type { Clip, ClipOptions, LearnOptions, LearntMaterial, ModelInfo, ReliefImage, Render, RenderOptions } from './haptoflow.d.ts';

export interface OfflineOptions {
  /** Bytes of a .haptoflow file; the shipped model unless given. */
  model?: Uint8Array;
  onProgress?: (share: number, doing: string) => void;
}

/** A model in Node, without sound: its calls block, `render` and `learn` for seconds. */
export interface Offline {
  readonly model: ModelInfo;
  render(options: Omit<RenderOptions, 'model' | 'base' | 'onnxRuntime' | 'sceneBase' | 'signal' | 'onProgress'>): Render;
  learn(options: Omit<LearnOptions, 'model' | 'base' | 'onnxRuntime' | 'signal' | 'onProgress'>): LearntMaterial;
  createClip(options: ClipOptions): Clip;
  /** Of the text of a .haptic, .ahap or .hjif file. @throws HaptoFlowError */
  readClip(text: string): Clip;
}

/** The pixels of a PNG file, bit by bit as the command line reads it. `name` is for messages. @throws HaptoFlowError */
export function decodePng(bytes: Uint8Array, name?: string): Promise<ReliefImage>;

export function openOffline(options?: OfflineOptions): Promise<Offline>;
