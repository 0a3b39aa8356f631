import type { LearnOptions, LearntMaterial, ModelInfo, Render, RenderOptions } from './haptoflow.d.ts';

export interface OfflineOptions {
  /** Bytes of a .haptoflow file; the shipped model unless given. */
  model?: Uint8Array;
  onProgress?: (share: number, doing: string) => void;
}

/** A model in Node, without sound: both calls take seconds and block. */
export interface Offline {
  readonly model: ModelInfo;
  render(options: Omit<RenderOptions, 'model' | 'base' | 'onnxRuntime' | 'signal' | 'onProgress'>): Render;
  learn(options: Omit<LearnOptions, 'model' | 'base' | 'onnxRuntime' | 'signal' | 'onProgress'>): LearntMaterial;
}

export function openOffline(options?: OfflineOptions): Promise<Offline>;
