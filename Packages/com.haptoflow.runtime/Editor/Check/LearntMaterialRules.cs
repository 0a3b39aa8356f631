#nullable enable
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;
using UnityEditor;

namespace HaptoFlow.Editor
{
    /// <summary>Learnt materials are felt only under the model that they were learnt for, and only so many at a time.
    /// </summary>
    internal static class LearntMaterialRules
    {
        public static IEnumerable<Finding> Check(SceneContents scene)
        {
            HapticMaterial[] materials = scene.Surfaces.Select(surface => surface.SharedDescription.Learnt)
                .OfType<HapticMaterial>().Distinct().ToArray();
            ModelSpace? model = materials.Length > 0 ? MaterialSummary.SpaceOf(LabelCatalog.ModelInUse()) : null;
            foreach (HapticMaterial material in materials)
            {
                string? problem = model == null ? null : ProblemOf(material, model);
                if (problem != null)
                {
                    yield return new Finding(MessageType.Warning, $"{material.name} is felt as its label " +
                        $"\"{material.Description.Label}\": {problem}", new[] { material });
                }
            }
            if (materials.Length > HapticEngine.MaximumMaterials)
            {
                yield return new Finding(MessageType.Warning, $"The scene's surfaces use {materials.Length} learnt " +
                    $"materials; an engine takes {HapticEngine.MaximumMaterials}, and the others are felt as their " +
                    "labels. Use fewer of them at one time.", materials);
            }
        }

        private static string? ProblemOf(HapticMaterial material, ModelSpace model)
        {
            try
            {
                MaterialFile file = MaterialFile.Read(material.Learnt);
                return file.Space == model.Id
                    ? null
                    : $"it was learnt for another model (its space is {file.Space}, the model's {model.Id}). Learn it " +
                        "again from its recording with this model, or choose the model that it was learnt for in " +
                        "Project Settings > HaptoFlow.";
            }
            catch (HaptoFlowException refusal)
            {
                return refusal.Message + ".";
            }
        }
    }
}
