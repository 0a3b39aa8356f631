#nullable enable
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;
using UnityEditor;

namespace HaptoFlow.Editor
{
    /// <summary>Checks that learnt materials belong to the model in use, and that there are no more of them than an
    /// engine takes.</summary>
    internal static class LearntMaterialRules
    {
        public static IEnumerable<Finding> Check(SceneContents scene)
        {
            IEnumerable<HapticMaterial?> ofMaps = scene.Maps.All.SelectMany(map =>
                map.Rules.Select(rule => rule.Material).Append(map.DefaultMaterial));
            HapticMaterial[] materials = scene.Surfaces.Select(surface => surface.SharedDescription.Learnt)
                .Concat(ofMaps.Select(material => material != null ? material.Description.Learnt : null))
                .OfType<HapticMaterial>().Distinct().ToArray();
            string? space = materials.Length > 0 ? SpaceOf(LabelCatalog.ModelInUse()) : null;
            foreach (HapticMaterial material in materials)
            {
                string? problem = space == null ? null : ProblemOf(material, space);
                if (problem != null)
                {
                    yield return new Finding(MessageType.Warning, $"{material.name} is felt as its label " +
                        $"\"{material.Description.Label}\": {problem}", new[] { material });
                }
            }
            if (materials.Length > HapticEngine.MaximumMaterials)
            {
                yield return new Finding(MessageType.Warning, $"Surfaces and maps use {materials.Length} learnt " +
                    $"materials, but an engine takes at most {HapticEngine.MaximumMaterials}; the others are felt as " +
                    "their labels. Use fewer of them at the same time.", materials);
            }
        }

        /// <summary>Null without a usable model, whose Inspector reports the problem.</summary>
        private static string? SpaceOf(HapticModelAsset? model)
        {
            try
            {
                return model == null ? null : model.Header.Space;
            }
            catch (HaptoFlowException)
            {
                return null;
            }
        }

        private static string? ProblemOf(HapticMaterial material, string space)
        {
            try
            {
                MaterialFile file = MaterialFile.Read(material.Learnt);
                return file.Space == space ? null : MaterialRegistration.ForeignSpace(file.Space, space);
            }
            catch (HaptoFlowException refusal)
            {
                return refusal.Message + ".";
            }
        }
    }
}
