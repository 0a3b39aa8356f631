#nullable enable
using System.Collections.Generic;
using UnityEditor.Build;
using UnityEditor.Build.Reporting;
using UnityEngine;
using UnityEngine.SceneManagement;

namespace HaptoFlow.Editor
{
    /// <summary>Writes the render pipeline's default material into every <see cref="PipelineMaterial"/> of a scene that
    /// goes into a player or into play mode. The scene's file does not change. Through the scene, players get the
    /// material and its shader.</summary>
    internal sealed class SceneMaterials : IProcessSceneWithReport
    {
        public int callbackOrder => 0;

        public void OnProcessScene(Scene scene, BuildReport report)
        {
            var found = new List<PipelineMaterial>();
            foreach (GameObject root in scene.GetRootGameObjects())
            {
                root.GetComponentsInChildren(true, found);
                foreach (PipelineMaterial each in found)
                {
                    if (each.Material == null)
                    {
                        each.Material = PipelineMaterial.OfPipeline();
                    }
                }
            }
        }
    }
}
