import type { LearnOptions, LearntMaterial, ModelInfo, ReliefImage, Render, RenderOptions } from './haptoflow.d.ts';

export interface OfflineOptions {
  /** Bytes of a .haptoflow file; the shipped model unless given. */
  model?: Uint8Array;
  onProgress?: (share: number, doing: string) => void;
}

/** A model in Node, without sound: both calls take seconds and block. */
export interface Offline {
  readonly model: ModelInfo;
  render(options: Omit<RenderOptions, 'model' | 'base' | 'onnxRuntime' | 'sceneBase' | 'signal' | 'onProgress'>): Render;
  learn(options: Omit<LearnOptions, 'model' | 'base' | 'onnxRuntime' | 'signal' | 'onProgress'>): LearntMaterial;
}

/** The pixels of a PNG file, bit by bit as the command line reads it. `name` is for messages. @throws HaptoFlowError */
export function decodePng(bytes: Uint8Array, name?: string): Promise<ReliefImage>;

export function openOffline(options?: OfflineOptions): Promise<Offline>;
