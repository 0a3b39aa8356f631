using System;
using UnityEngine.SceneManagement;
using UnityShim;

namespace UnityEditor.SceneManagement
{
    public enum NewSceneMode
    {
        Single = 0,
        Additive = 1,
    }

    public enum NewSceneSetup
    {
        EmptyScene = 0,
        DefaultGameObjects = 1,
    }

    public sealed partial class EditorSceneManager : SceneManager
    {
        public static bool SaveCurrentModifiedScenesIfUserWantsTo() => !EditorSession.CancelsSaving;

        public static Scene NewScene(NewSceneSetup setup, NewSceneMode mode)
        {
            if (World.IsPlaying)
            {
                throw new InvalidOperationException("This cannot be used during play mode.");
            }
            if (setup != NewSceneSetup.EmptyScene || mode != NewSceneMode.Single)
            {
                throw new NotSupportedException("the shim opens empty scenes only, in place of the open one");
            }
            World.LoadEmptyScene();
            EditorSession.SceneIsDirty = false;
            return default;
        }

        public static bool MarkSceneDirty(Scene scene) => EditorSession.SceneIsDirty = true;
    }
}
