/**
 * HaptoFlow in a browser: the vibration of a tip that slides over a material, as sound and as points for motors.
 *
 * Numbers carry their unit in their name: m/s^2 (Mps2), m/s (Mps), metres, newtons, milliseconds (Ms), seconds. Frames are
 * Unity's: left-handed, y up. +-1 in samples is `fullScaleMps2`, 200 m/s^2 unless set. Every call is for the page's thread.
 */

/** The sketch plays without a network; "auto" measures this device and takes the most accurate quality that it keeps up with. */
export type Quality = 'sketch' | 'draft' | 'standard' | 'auto';

/** A label of the model or the name of an added material, or up to four of them with weights from 0 to 1. */
export type Material = string | Record<string, number>;

export interface Label {
  readonly name: string;
  readonly category: string;
  /** What a contact state refers to: labels of the model first, then added materials. */
  readonly index: number;
  /** True for an added material. */
  readonly isAdded: boolean;
  readonly isPeriodic: boolean;
  readonly wavelengthMetres: number;
  readonly stiffnessNewtonsPerMetre: number;
  readonly frictionCoefficient: number;
}

export interface Tier {
  readonly name: string;
  /** "flow", "average-velocity", "direct", "skeleton" or "refine". */
  readonly kind: string;
  readonly isDefault: boolean;
  readonly steps: number;
  readonly parameterCount: number;
  /** Figures of the model's header, as objects; empty where nothing was measured. */
  readonly accuracy: Readonly<Record<string, unknown>>;
  readonly cost: Readonly<Record<string, unknown>>;
}

export interface ModelInfo {
  readonly name: string;
  readonly description: string;
  /** How it was trained, on which recordings, and their licence. */
  readonly statement: string;
  readonly recordings: string;
  readonly licence: string;
  /** The range that the model was trained on: lowest, highest. */
  readonly speedMps: readonly [number, number];
  readonly forceNewtons: readonly [number, number];
  readonly labels: readonly Label[];
  readonly tiers: readonly Tier[];
}

/** Where the engine's own files are. All default to the folder of haptoflow.mjs. */
export interface Locations {
  /** Folder of engine.wasm and of the engine's scripts. */
  base?: string | URL;
  /** Folder of ort-wasm-simd-threaded.mjs and ort-wasm-simd-threaded.wasm. */
  onnxRuntime?: string | URL;
}

export interface CreateOptions extends Locations {
  /** Address or bytes of a .haptoflow file; `model.haptoflow` beside haptoflow.mjs unless given. */
  model?: string | URL | ArrayBuffer | Uint8Array;
  /** "standard" unless given. */
  quality?: Quality;
  /** An own context, which `close` then leaves open; else one of 48 kHz with the shortest latency is made. */
  context?: AudioContext;
  /** Where the sound goes: the context's destination unless given; null to connect `output` oneself. */
  destination?: AudioNode | null;
  /** Seed of all noise, a whole number from 0; 1 unless given. */
  seed?: number;
  /** A fixed time from a contact state to its first sample, above 0 to 50; 0 for the shortest that this device keeps. */
  leadMs?: number;
  /** Contact states per second that the page publishes, 1 to 10000; 72 unless given. Sets the budget of "auto". */
  updateRateHz?: number;
  /** The acceleration that is +-1 in the output; 200 unless given. */
  fullScaleMps2?: number;
  /**
   * How sound reaches the audio thread: "shared" renders there, in memory that page, worker and audio thread share, and needs
   * a page served with the headers COOP and COEP; "ring" renders in the worker and sends blocks; "auto" is "shared" where the
   * page may, else "ring".
   */
  sharing?: 'auto' | 'shared' | 'ring';
  /** Frames that the ring keeps ahead at first; 2048 unless given. */
  ringFrames?: number;
  /** Ends loading; `create` then rejects with the code "aborted". */
  signal?: AbortSignal;
  /** Share of loading that is done, 0 to 1, and what is done now. */
  onProgress?: (share: number, doing: string) => void;
}

/** What the tip does now. Only `touching` is needed; all else is 0 or none where it is missing. */
export interface ContactState {
  touching: boolean;
  /** None is the voice's last material; before that the model's first label. */
  material?: Material;
  /** Along two axes fixed to the surface. Up to 20 m/s each. */
  velocityMps?: readonly [number, number];
  /** Along the surface's normal, 0 to 1000. */
  forceNewtons?: number;
  /** Speed into the surface at the newest touch-down or landing: strength of the impact. */
  approachSpeedMps?: number;
  /** Incremented at each touch-down, so that a tap between two states is felt; 0 counts by `touching` alone. */
  touchCounter?: number;
  /** Incremented at each landing on another surface while touching. */
  landingCounter?: number;
  /** Incremented at each rim that is crossed, with the height of the newest. */
  edgeCounter?: number;
  edgeHeightMetres?: number;
  /** Size of the surface's features relative to the material's, 0.25 to 4. */
  spatialScale?: number;
  /** Brighter above 0, darker below: -12 to 12. */
  toneDbPerOctave?: number;
  /** How much this object differs from others of its labels, 0 to 1. */
  variation?: number;
  /** Names the surface: equal places of one seed feel equal in every touch. */
  surfaceSeed?: number;
  /** The contact point in a frame fixed to the surface; with it go the axes of velocityMps in that frame, x and z unless given. */
  placeMetres?: readonly [number, number, number];
  firstAxis?: readonly [number, number, number];
  secondAxis?: readonly [number, number, number];
  /** The heights under the tip. */
  relief?: Relief | null;
  /** Where the contact point lies in the relief's map: 0 to 1 along columns and rows; a tiled map goes on beyond. */
  reliefPlace?: readonly [number, number];
  /** Share of the full scale that the relief may reach, 0 to 1; 0.5 unless given. */
  reliefShare?: number;
  /** Replaces the voice's `effects` for this state. */
  effects?: EffectChoice;
}

/** A map of heights. */
export interface ReliefOptions {
  /** Texels, 1 to 3 * 2^20 in all. */
  columns: number;
  rows: number;
  /** Columns by rows heights, row by row, the first row at 0; limited to 0 to `depthMetres`. Copied. */
  heightsMetres: Float32Array;
  /** Length of the map along its columns and along its rows. */
  sizeMetres: readonly [number, number];
  /** The range of the heights, above 0. */
  depthMetres: number;
  /** Radius of the tip's ball, 0 to 0.05: it does not reach the bottom of a groove that is narrower. 0.0005, a pen's, unless given. */
  tipRadiusMetres?: number;
  /** Whether the map goes on at its rims with the opposite one, else the rim's heights go on; true unless given. */
  isTiled?: boolean;
}

/**
 * A decoded image: four numbers for each pixel, row by row: red, green, blue and opacity, of which the last is ignored. They end at 255,
 * at 65535 in a Uint16Array, at 1 in a Float32Array. An ImageData is one, and `decodePng` of haptoflow-web/node gives one.
 */
export interface ReliefImage {
  readonly width: number;
  readonly height: number;
  readonly data: Uint8ClampedArray | Uint8Array | Uint16Array | Float32Array;
}

/** A relief of an image, which lies as it is drawn: heights from black (0) to white (the depth), of the mean of its colours. */
export interface ReliefImageOptions extends Omit<ReliefOptions, 'columns' | 'rows' | 'heightsMetres'> {
  image: ReliefImage;
  /** The image has normals, right in red, up in green, outwards in blue; their heights then span the depth. Takes seconds, in a worker. */
  isNormalMap?: boolean;
}

/** What a scene says of a surface's relief; see Documentation~/scene-and-stroke.md. */
export interface SceneRelief {
  /** The name of a PNG file, relative to the scene. */
  readonly image: string;
  readonly isNormalMap: boolean;
  readonly sizeMetres: readonly [number, number];
  readonly depthMetres: number;
  readonly isTiled: boolean;
  readonly share: number;
}

/** Heights that the tip of a pen follows, pressed on a spring: gaps, ribs, letters. Stays the same over recoveries. */
export interface Relief extends Readonly<Required<ReliefOptions>> {
  /** By which contact states name it; never 0, and never used again. */
  readonly number: number;
  /** Its heights as a PNG file of 16 bits, for `relief` in a scene. */
  png(): Promise<Uint8Array>;
  /** A state or a surface that still names it has no relief from then on. */
  destroy(): void;
}

/** What sounds; all true where it is missing, except at the command line, where texture alone is the default. */
export interface EffectChoice {
  texture?: boolean;
  impact?: boolean;
  edge?: boolean;
  /** Sounds where a surface or a state has a relief, at the command line, too. */
  relief?: boolean;
}

export type SilenceReason =
  | 'none' | 'rest' | 'stale' | 'muted' | 'paused' | 'panic' | 'rate' | 'closing' | 'worker-dead' | 'turned-down'
  /** The audio context does not run: it waits for a gesture, or the system took the device. */
  | 'context';

export interface EffectStatistics {
  readonly isAskedFor: boolean;
  /** Blocks that it ran for; 0 for an effect that was never asked for. */
  readonly runs: number;
  /** Their time together; 0 with shared memory for all but the texture: the audio thread has no clock. See `measureEffects`. */
  readonly microseconds: number;
  /** Impacts or edges that sounded; starts of clips. */
  readonly events: number;
}

export interface VoiceStatistics {
  readonly silence: SilenceReason;
  /** From what sounds now to the start of a new segment. */
  readonly leadMs: number;
  readonly updates: number;
  readonly inferences: number;
  readonly inferenceMs: number;
  readonly onsets: number;
  readonly taps: number;
  /** Blocks without samples; a model with a skeleton has none. */
  readonly underruns: number;
  /** Blocks that the skeleton played alone. */
  readonly sketched: number;
  readonly late: number;
  readonly dropped: number;
  readonly failures: number;
  readonly sanitised: number;
  readonly staleStops: number;
  readonly nonFiniteSamples: number;
  readonly limitedSamples: number;
  readonly renderedFrames: number;
  readonly resumptions: number;
  /** Blocks that came too late through the ring; 0 with shared memory. */
  readonly ringUnderruns: number;
  readonly effects: Readonly<Record<'texture' | 'impact' | 'edge' | 'relief' | 'clip' | 'delay' | 'compensation' | 'listen', EffectStatistics>>;
}

export interface TierTimes {
  readonly name: string;
  readonly isCurrent: boolean;
  readonly runs: number;
  readonly medianMs: number;
  readonly percentile99Ms: number;
}

export interface Statistics {
  /** "shared": the audio thread renders. "ring": the worker renders; its blocks pass through `ringFrames` more frames, which grow where blocks came too late. */
  readonly sharing: 'shared' | 'ring';
  /** Why there is no shared memory; empty with it. */
  readonly sharingNote: string;
  readonly ringFrames: number;
  readonly quality: Quality;
  /** The tier that generates at present. */
  readonly tier: string;
  readonly isMeasuring: boolean;
  readonly rounds: number;
  readonly segments: number;
  readonly failedRounds: number;
  readonly budgetMs: number;
  readonly lastRoundMs: number;
  readonly qualityStepsDown: number;
  readonly qualityStepsUp: number;
  readonly workerIsAlive: boolean;
  /** The message of the newest failure; empty for none. */
  readonly lastFailure: string;
  readonly tiers: readonly TierTimes[];
  /** How often the engine was started again after a fault. */
  readonly recoveries: number;
  readonly memoryBytes: number;
  /** Of the audio context; NaN where the browser does not say. */
  readonly sampleRateHz: number;
  readonly baseLatencyMs: number;
  readonly outputLatencyMs: number;
  /** The output was unplugged, and there is no other; the engine goes on for motors and takes the next one. */
  readonly hasLostOutput: boolean;
  /** Gaps that the browser counted in its output, whatever their cause; not a number where it does not count. */
  readonly outputUnderruns: number;
}

/** The wave of a voice as it is played, +-1 at full scale: for meters, oscilloscopes and recordings. */
export interface WaveTap {
  readonly sampleRateHz: number;
  /** Frames tapped since it was opened. */
  readonly written: number;
  /** Copies the newest samples into `into`, the oldest first, zeros before the first. */
  latest(into: Float32Array): void;
  /** Copies what was not read yet, as much as fits, and returns its number; what is older than the tap's memory is lost. */
  read(into: Float32Array): number;
  close(): void;
}

/** One frame for a device with a single carrier, at the perceived intensity of the wave. */
export interface MotorPoint {
  /** On the audio context's clock, of the frame's first sample. */
  readonly timeSeconds: number;
  readonly durationSeconds: number;
  /** Peak of a sinusoid of this frequency. */
  readonly amplitudeMps2: number;
  readonly frequencyHz: number;
  /** Part of the device's range by the loudness law of motors, 0 to below 1: what a rumble or a pulse takes. */
  readonly share: number;
  /** A tap or an edge within the frame; 0 for none. */
  readonly transientShare: number;
  readonly transientOffsetSeconds: number;
}

export interface MotorOptions {
  /** Length of a frame, 0.002 to 0.032; 0.005 unless given. */
  frameSeconds?: number;
  /** Range of the device, above 0 to 1000; 60 and 400 unless given. */
  minimumFrequencyHz?: number;
  maximumFrequencyHz?: number;
}

export interface MotorTap {
  /** The frames since the last call, the oldest first; at most the last second. Allocates. */
  read(): MotorPoint[];
  /** The largest share since the last call of `peak`: for an output at the page's frame rate. Allocates nothing. */
  peak(): number;
  close(): void;
}

/** The signal of one tip. */
export interface Voice {
  /** Stays the same over recoveries; connect it where its sound should go instead of `HaptoFlow.output`. */
  readonly node: AudioNode;
  /** The effects of states that do not choose their own. */
  effects: EffectChoice;
  /** Before the limiter, 0 to 1. */
  gain: number;
  /** The largest magnitude, 0 to 1. */
  ceiling: number;
  muted: boolean;
  paused: boolean;
  /** Louder and brighter, for ears only. */
  listen: boolean;
  /** Delays all, 0 to 500. */
  delayMs: number;
  /** "voice-coil", "flat", the text of an actuator profile, or null. */
  actuator: string | null;
  /** Publishes what the tip does now: once a frame, and while nothing touches too. Silent after 100 ms without a state. */
  publish(state: ContactState): void;
  /** Shorthand for a state that does not touch. */
  lift(): void;
  /** Silences this touch at once; the next one sounds. */
  panic(): void;
  /**
   * Plays a clip beside the texture, with or without contact, once or until another one or `stopClip`: at once, except that an
   * engine first loads a clip which it has not, in some milliseconds for each second of it. Needs states, of a tip in the air
   * too: without them, and by mute, pause, panic and a fault, it ends. A voice plays one clip at a time. `gain` is 0 to 4.
   */
  playClip(clip: Clip, options?: { gain?: number; isLoop?: boolean }): Promise<void>;
  stopClip(): void;
  statistics(): VoiceStatistics;
  /** `seconds` is how much it remembers, up to 60; 2 unless given. */
  waveTap(options?: { seconds?: number }): WaveTap;
  motorTap(options?: MotorOptions): MotorTap;
  close(): Promise<void>;
}

/** The tip of a stylus in the scene's frame. */
export interface TipSample {
  timeSeconds: number;
  /** Centre of the tip. */
  positionMetres: readonly [number, number, number];
  /** Measured by the stylus; without it the force is a spring's: stiffness by depth. */
  forceNewtons?: number;
  /** x, y, z, w. */
  orientation?: readonly [number, number, number, number];
}

/** What a scene says of a tip: a contact state and where it comes from. The same object at every call of one scene. */
export interface SceneContact extends ContactState {
  timeSeconds: number;
  /** Index in `Scene.surfaces`; -1 for none. */
  surfaceIndex: number;
  surfaceName: string;
  penetrationMetres: number;
  contactMetres: [number, number, number];
  normal: [number, number, number];
}

export interface SceneSurface {
  readonly index: number;
  readonly name: string;
  readonly material: Material;
  /** Where the scene names one: `HaptoFlow.loadReliefs` lays it. */
  readonly relief?: SceneRelief;
}

/** The contact model of the command line's scenes (Documentation~/scene-and-stroke.md), with one tip. */
/** Of a surface, in the scene's frame: metres, and a unit quaternion x, y, z, w. */
export interface Pose {
  position: number[];
  rotation: number[];
}

export interface Scene {
  readonly updateRateHz: number;
  readonly tipRadiusMetres: number;
  readonly surfaces: readonly SceneSurface[];
  /** Computes contact. Times must not go back; `reset` begins again. Takes microseconds. */
  update(tip: TipSample): SceneContact;
  /** `update`, then publishes the state on a voice. */
  publish(voice: Voice, tip: TipSample): SceneContact;
  /** Changes how a surface feels, from the next update on. */
  setSurface(surface: number | string, change: {
    material?: Material; spatialScale?: number; toneDbPerOctave?: number; variation?: number;
  }): void;
  /**
   * Lays a relief on a surface, from the next update on, or takes it away: along the two axes of `velocityMps`, its 0 at the origin
   * of the surface's frame. `share` is that of the full scale which it may reach, 0 to 1; 0.5 unless given.
   */
  setRelief(surface: number | string, relief: Relief | null, options?: { share?: number }): void;
  /** Writes where the surface of an index is at a time, moved or at rest, and returns what it wrote into. For drawing. */
  poseOf(surface: number, timeSeconds: number, into: Pose): Pose;
  /** Forgets the tip's history, after it was lost or moved at once. */
  reset(): void;
  close(): void;
}

export interface RenderOptions extends Locations {
  /** Of the instance, if `render` is called on one. */
  model?: CreateOptions['model'];
  /** SCENE.json as text or object. */
  scene: string | object;
  /** STROKE.csv as text. */
  stroke: string;
  /** A tier's name; the model's default unless given. */
  quality?: string;
  seed?: number;
  leadMs?: number;
  rateHz?: number;
  /** Texture alone unless given, as at the command line. */
  effects?: EffectChoice;
  listen?: boolean;
  actuator?: string | null;
  delayMs?: number;
  fullScaleMps2?: number;
  /** Texts of material files, whose names the scene may use. */
  materials?: readonly string[];
  /** Reliefs by the names of their surfaces, with `share` as in `Scene.setRelief`. */
  reliefs?: Readonly<Record<string, (ReliefOptions | ReliefImageOptions) & { share?: number }>>;
  /** Images by the names that the scene gives them. A browser reads the others from `sceneBase`; Node must be given all. */
  images?: Readonly<Record<string, ReliefImage>>;
  /** The scene's address or its folder's, for images; the page's unless given. In a browser only. */
  sceneBase?: string | URL;
  signal?: AbortSignal;
  onProgress?: (share: number, doing: string) => void;
}

export interface Render {
  /** What `haptoflow render` writes, within 1e-6 of its peak. */
  readonly samples: Float32Array;
  readonly rateHz: number;
  /** What +-1 is. */
  readonly fullScaleMps2: number;
  readonly tier: string;
  readonly seconds: number;
  readonly touches: number;
  readonly silentTouches: number;
  readonly segments: number;
  readonly inferenceMsMedian: number;
  readonly inferenceMsP99: number;
}

/** `.haptic` 1.0.0 of Meta, `.ahap` of Apple, `.hjif` of MPEG-I; Documentation~/effects-and-outputs.md says what each loses. */
export type ClipFormat = 'haptic' | 'ahap' | 'hjif';

/** A wave, at most 600 s; a `Render` has what it needs. */
export interface ClipOptions {
  samples: Float32Array;
  /** 8000 to 192000. */
  rateHz: number;
  /** What +-1 is; the engine's unless given, else 200. 1 for samples in m/s^2. */
  fullScaleMps2?: number;
  /** The wave goes on at its beginning. */
  isLoop?: boolean;
  /** What files say of the clip. */
  title?: string;
  description?: string;
  source?: string;
}

/** A short, sudden pulse: a tap or an edge. */
export interface ClipTransient {
  readonly timeSeconds: number;
  /** Share of a device's range, 0 to 1. */
  readonly amplitude: number;
  readonly frequencyHz: number;
}

/** A vibration as other tools and devices play it. Data alone: it may be copied, and any engine plays it. */
export interface Clip {
  readonly format: ClipFormat;
  readonly seconds: number;
  readonly amplitudePoints: number;
  readonly frequencyPoints: number;
  readonly transients: readonly ClipTransient[];
  /** Evenly from the clip's start to its end, about every 4 ms: shares of a device's range, 0 to 1. */
  readonly amplitude: Float32Array;
  /** At the same times. */
  readonly frequencyHz: Float32Array;
  readonly largestAmplitude: number;
  readonly title: string;
  readonly description: string;
  /** The program that wrote it. */
  readonly editor: string;
  /** In words, what the file has and the clip has not; empty for nothing. */
  readonly omitted: string;
  /** What is played: the text that was read; of a wave, that of its .haptic file. */
  readonly text: string;
  /** The clip written in each format. */
  readonly files: Readonly<Record<ClipFormat, string>>;
}

export interface RecordingFile {
  /** With its ending, without a folder. */
  name: string;
  bytes: ArrayBuffer | Uint8Array;
}

/** Samples of a recording; give velocity and force for each sample, or constants. */
export interface RecordingSamples {
  name: string;
  /** One axis, or three interleaved. */
  accelerationMps2: Float32Array;
  axisCount?: 1 | 3;
  sampleRateHz: number;
  /** vx and vy for each sample. */
  velocityMps?: Float32Array;
  constantVelocityMps?: readonly [number, number];
  forceNewtons?: Float32Array;
  constantForceNewtons?: number;
}

export interface LearnOptions extends Locations {
  model?: CreateOptions['model'];
  /** The .csv or .wav file first, then its sidecar and motion table; or samples. At least 10 s of sliding. */
  recording: readonly RecordingFile[] | RecordingSamples;
  /** For .wav files without a sidecar: what +-1 stands for. */
  wavFullScaleMps2?: number;
  /** The material's name, lower case; of the file unless given. */
  name?: string;
  category?: string;
  description?: string;
  licence?: string;
  /** Of the tier that is fitted; the model's default unless given. */
  quality?: string;
  seed?: number;
  /** Of processor time for the fit; 60 unless given. */
  secondsLimit?: number;
  /** Ends learning at once; `learn` then rejects with the code "aborted". */
  signal?: AbortSignal;
  onProgress?: (share: number, doing: string) => void;
}

export interface LearntMaterial {
  readonly name: string;
  /** Text of a .haptomaterial file, for `addMaterial` and for download. */
  readonly material: string;
  /** Results (haptoflow_learning_results): start_label, fitted_distance_db, warnings, record_next and more. */
  readonly report: Readonly<Record<string, unknown>>;
  /** What was ignored or corrected in the recording. */
  readonly notes: readonly string[];
}

/** Every error of this package. `code` is for programs, `message` for people: it names what is wrong and the remedy. */
export class HaptoFlowError extends Error {
  /**
   * "model-unreachable", "engine-unreachable", "runtime-unreachable", "worker-lost", "audio-unavailable", "aborted", "closed",
   * "invalid-argument", "input", or a status of the C interface such as "MODEL_TRUNCATED".
   */
  readonly code: string;
}

export interface HaptoFlowEvents {
  /** Something failed; where `isFatal`, the engine stays silent. */
  error: CustomEvent<{ error: HaptoFlowError; isFatal: boolean }>;
  /** The engine was started again after a fault; voices, materials and reliefs are as before. */
  recovered: CustomEvent<{ reason: string; milliseconds: number }>;
  /** A voice changed to silence for a reason other than rest, or sounds again (`reason` "none"). */
  silent: CustomEvent<{ voice: Voice; reason: SilenceReason }>;
  /** The tier that generates has changed. */
  quality: CustomEvent<{ tier: string }>;
  /** The context's state: "suspended" asks for `resume` in a gesture. */
  context: CustomEvent<{ state: string }>;
  /**
   * The sound's output was unplugged. "lost": only ears miss something until "back", when another one has taken its place;
   * "stopped": this browser cannot go on, and the page must be loaded again.
   */
  device: CustomEvent<{ state: 'lost' | 'stopped' | 'back' }>;
}

/** Times by nearest rank. */
export interface Distribution {
  readonly count: number;
  readonly minimum: number;
  readonly median: number;
  readonly percentile99: number;
  readonly worst: number;
}

/** One row of a measurement: one tier on this device. */
export interface Measurement {
  readonly tier: string;
  /** One segment after the other. */
  readonly hotMs: Distribution;
  /** One segment per update, with idle time between. */
  readonly pacedMs: Distribution;
}

/** What one effect costs on this device. */
export interface EffectMeasurement {
  readonly effect: 'texture' | 'impact' | 'edge' | 'relief' | 'clip' | 'delay' | 'compensation' | 'listen';
  /** Added to a block of 128 frames by this effect alone; the texture's is that of a voice with nothing else. */
  readonly microsecondsPerBlock: number;
}

/** The engine: one model, its worker and its voices. */
export class HaptoFlow extends EventTarget {
  /**
   * Loads model, engine and ONNX Runtime and starts the worker. The context may still wait for a gesture: call `resume` in one.
   * @throws HaptoFlowError
   */
  static create(options?: CreateOptions): Promise<HaptoFlow>;
  /** Renders a stroke over a scene as the command line does, in a worker of its own. @throws HaptoFlowError */
  static render(options: RenderOptions): Promise<Render>;
  /** Learns a material from a recording, in a worker of its own. @throws HaptoFlowError */
  static learn(options: LearnOptions): Promise<LearntMaterial>;
  /** Whether this page may share memory between threads (COOP and COEP). */
  static readonly canShareMemory: boolean;
  /** Of a relief. */
  static readonly mostTexels: number;
  /**
   * The pixels of a picture, with all 16 bits of a PNG file; other kinds come through a canvas, which has 8 and no colours where they
   * are transparent. One of more than `mostPixels` is made smaller. @throws HaptoFlowError
   */
  static decodeImage(file: Blob, options?: { mostPixels?: number }): Promise<ReliefImage & { readonly fullWidth: number; readonly fullHeight: number }>;

  readonly model: ModelInfo;
  /** Those of the model and what was added. */
  readonly labels: readonly Label[];
  readonly context: AudioContext;
  /** The sum of all voices. */
  readonly output: AudioNode;
  readonly voices: readonly Voice[];
  readonly quality: Quality;

  /** From the next segment on. */
  setQuality(quality: Quality): Promise<void>;
  openVoice(options?: Partial<Pick<Voice, 'effects' | 'gain' | 'ceiling' | 'listen' | 'delayMs' | 'actuator'>>): Promise<Voice>;
  /** Adds a learnt material as a label, or replaces the one of its name. Text or object of a .haptomaterial file. */
  addMaterial(material: string | object): Promise<Label>;
  /** Makes a relief of heights, for any number of surfaces, scenes and states. Takes about 0.1 s for 10^6 texels. */
  createRelief(options: ReliefOptions | ReliefImageOptions): Promise<Relief>;
  /** Makes a clip of a wave, such as a render's or a wave tap's, in a worker of its own. @throws HaptoFlowError */
  createClip(options: ClipOptions): Promise<Clip>;
  /** Reads the text of a .haptic, .ahap or .hjif file, at most 16 MiB and 600 s, in a worker of its own. @throws HaptoFlowError that names the key */
  readClip(text: string): Promise<Clip>;
  /** Frees what this engine keeps of a clip that it has played; it may be played again. A voice that plays it plays on. */
  forgetClip(clip: Clip): void;
  /** Reads SCENE.json, text or object; `loadReliefs` then loads the images of its reliefs. Throws HaptoFlowError that names the key. */
  loadScene(scene: string | object): Scene;
  /**
   * Makes the reliefs that a scene names and lays them on its surfaces: of `images`, or of the PNG files beside the scene at `sceneBase`
   * (the page's address unless given). Whoever closes the scene destroys them. @throws HaptoFlowError that names file, key and remedy
   */
  loadReliefs(scene: Scene, options?: Pick<RenderOptions, 'images' | 'sceneBase' | 'signal'>): Promise<Relief[]>;
  render(options: RenderOptions): Promise<Render>;
  learn(options: LearnOptions): Promise<LearntMaterial>;
  /** Times tiers in a worker of its own; all of the model unless named. */
  measure(options?: { tiers?: readonly string[]; seconds?: number; signal?: AbortSignal; onProgress?: (share: number, doing: string) => void }): Promise<Measurement[]>;
  /** Times every effect in a worker of its own: the arithmetic of the audio thread, without inference. Takes about 2 s. */
  measureEffects(options?: { signal?: AbortSignal }): Promise<EffectMeasurement[]>;
  statistics(): Statistics;
  /** Resumes the audio context: call it in a gesture. */
  resume(): Promise<void>;
  /** Silences all that touches now. */
  panic(): void;
  close(): Promise<void>;

  addEventListener<K extends keyof HaptoFlowEvents>(type: K, listener: (event: HaptoFlowEvents[K]) => void, options?: boolean | AddEventListenerOptions): void;
  addEventListener(type: string, listener: EventListenerOrEventListenerObject | null, options?: boolean | AddEventListenerOptions): void;
  removeEventListener<K extends keyof HaptoFlowEvents>(type: K, listener: (event: HaptoFlowEvents[K]) => void, options?: boolean | EventListenerOptions): void;
  removeEventListener(type: string, listener: EventListenerOrEventListenerObject | null, options?: boolean | EventListenerOptions): void;
}
