#nullable enable
using System.Collections.Generic;
using UnityEditor.Build;
using UnityEditor.Build.Reporting;
using UnityEngine;
using UnityEngine.SceneManagement;

namespace HaptoFlow.Editor
{
    /// <summary>Writes the render pipeline's default material into every <see cref="PipelineMaterial"/> of a scene as
    /// it goes into a player or into play mode; the scene's file stays as it is. Players get the material and its
    /// shader with the scene.</summary>
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
