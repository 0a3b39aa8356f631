#nullable enable
using System.Collections.Generic;
using UnityEditor;

namespace HaptoFlow.Editor
{
    /// <summary>Checks that the project has settings with a usable model, which player builds include.</summary>
    internal static class SettingsRules
    {
        public static IEnumerable<Finding> Check()
        {
            HaptoFlowSettings? settings = ProjectSettingsAsset.Find();
            if (settings == null)
            {
                yield return new Finding(MessageType.Warning,
                    "The project has no HaptoFlow settings: a player build would have no model and stay silent.", null,
                    new Repair("Create Settings", () => ProjectSettingsAsset.FindOrCreate()));
                yield break;
            }
            if (!ProjectSettingsAsset.ReachesPlayers(settings))
            {
                yield return new Finding(MessageType.Warning,
                    $"{settings.name} is not among the preloaded assets: a player build would not include it.",
                    new[] { settings },
                    new Repair("Add to Preloaded Assets", () => ProjectSettingsAsset.Preload(settings)));
            }
            Finding? ofModel = CheckModel(settings);
            if (ofModel != null)
            {
                yield return ofModel;
            }
        }

        private static Finding? CheckModel(HaptoFlowSettings settings)
        {
            HapticModelAsset? model = settings.Model;
            HapticModelAsset? other = ProjectSettingsAsset.DefaultModel();
            Repair[] repairs = other == null || other == model
                ? new Repair[0]
                : new[] { new Repair("Use the Package's Model", () => Choose(settings, other)) };
            if (model == null)
            {
                return new Finding(MessageType.Error, "The settings have no model: nothing is felt. Choose one in " +
                    "Project Settings > HaptoFlow.",
                    new[] { settings }, repairs);
            }
            string? problem = ModelCheck.ProblemOf(model.File)?.Text;
            return problem == null
                ? null
                : new Finding(MessageType.Error, $"The model {model.name} cannot be used: {problem}.",
                    new[] { model }, repairs);
        }

        private static void Choose(HaptoFlowSettings settings, HapticModelAsset model) =>
            SerializedFields.Set(settings, "model", property => property.objectReferenceValue = model);
    }
}
