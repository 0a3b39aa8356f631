/** Unity's modules by the kinds of objects in scenes and prefabs: the number after "!u!". */
export const modulesOfClasses = {
  54: 'physics', 64: 'physics', 65: 'physics', 135: 'physics', 136: 'physics', 143: 'physics',
  81: 'audio', 82: 'audio',
  154: 'terrainphysics', 218: 'terrain',
  196: 'ai',
};

/** Unity's modules by words of C# that only code which needs the module contains. */
export const modulesOfWords = {
  AndroidJavaObject: 'androidjni',
  AnimationCurve: 'animation',
  AudioSource: 'audio',
  BoxCollider: 'physics',
  GUILayout: 'imgui',
  ImageConversion: 'imageconversion',
  JsonUtility: 'jsonserialize',
  ParticleSystem: 'particlesystem',
  Physics2D: 'physics2d',
  SubsystemManager: 'subsystems',
  TerrainCollider: 'terrainphysics',
  TerrainData: 'terrain',
  UIElements: 'uielements',
  UnityWebRequest: 'unitywebrequest',
  XRDisplaySubsystem: 'xr',
};
