#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>Checks the open scenes and the project. Changes nothing by itself.</summary>
    internal static class SceneCheck
    {
        public static IReadOnlyList<Finding> Run() => Run(new SceneContents());

        /// <summary>All findings in contents that were already collected, the most severe first.</summary>
        public static IReadOnlyList<Finding> Run(SceneContents scene)
        {
            return SettingsRules.Check()
                .Concat(StylusRules.Check(scene))
                .Concat(PenRules.Check(scene))
                .Concat(SurfaceRules.Check(scene))
                .Concat(LearntMaterialRules.Check(scene))
                .Concat(ColliderRules.Check(scene))
                .Concat(MapRules.Check(scene))
                .Concat(ReliefRules.Check(scene))
                .Concat(OutputRules.Check(scene))
                .Concat(SilentOutputRules.Check(scene))
                .Concat(PlaceRules.Check(scene))
                .Concat(RealObjectRules.Check(scene))
                .Concat(EffectRules.Check(scene))
                .OrderByDescending(finding => finding.Severity)
                .ToArray();
        }
    }

    /// <summary>A remedy for a finding.</summary>
    /// <param name="Caption">The text of its button.</param>
    internal sealed record Repair(string Caption, Action Act)
    {
        /// <summary>Remedies for a field "hand" that is not set.</summary>
        public static Repair[] ChooseHand(Object target) => new[] { HapticHand.Right, HapticHand.Left }
            .Select(hand => new Repair($"{hand} Hand", () => SerializedFields.Set(
                target, "hand", property => property.enumValueIndex = (int)hand))).ToArray();
    }

    /// <summary>A problem of the scene or the project that prevents or degrades haptics.</summary>
    /// <param name="Severity">Error: nothing is felt. Warning: something is not felt. Info: a remark.</param>
    /// <param name="About">The objects with the problem; null when it concerns the project.</param>
    internal sealed record Finding(
        MessageType Severity, string Text, IReadOnlyList<Object>? About = null, params Repair[] Repairs)
    {
        public IReadOnlyList<Object> Objects => About ?? Array.Empty<Object>();
    }

    /// <summary>The active objects of the open scenes that matter to haptics.</summary>
    internal sealed class SceneContents
    {
        public SceneContents()
        {
            Styluses = All<HapticStylus>();
            Surfaces = All<HapticSurface>();
            Outputs = All<HapticOutput>();
            SwitchedOffOutputs = AllOfThem<HapticOutput>().Where(output => !output.isActiveAndEnabled).ToArray();
            AllDeviceOutputs = AllOfThem<DeviceOutput>().Where(output => !output.IsMade).ToArray();
            Colliders = SceneColliders.InScenes().Where(IsInReach).ToArray();
            Maps = new SceneMaps();
            Answers = Colliders.Select(Maps.Ask).ToArray();
        }

        public IReadOnlyList<HapticStylus> Styluses { get; }
        public IReadOnlyList<HapticSurface> Surfaces { get; }
        public IReadOnlyList<HapticOutput> Outputs { get; }
        public IReadOnlyList<HapticOutput> SwitchedOffOutputs { get; }

        /// <summary>The outputs that play in a hand, switched on or off, without those made automatically.</summary>
        public IReadOnlyList<DeviceOutput> AllDeviceOutputs { get; }

        public IEnumerable<DeviceOutput> DeviceOutputs => AllDeviceOutputs.Where(output => output.isActiveAndEnabled);

        /// <summary>The colliders that can be felt, on the layers of any stylus; without one, on all layers.</summary>
        public IReadOnlyList<Collider> Colliders { get; }

        public SceneMaps Maps { get; }

        /// <summary>What each of <see cref="Colliders"/> feels like, and why.</summary>
        public IReadOnlyList<ColliderMaterial> Answers { get; }

        private bool IsInReach(Collider collider)
        {
            int layer = 1 << collider.gameObject.layer;
            return Styluses.Count == 0 || Styluses.Any(stylus => (stylus.Layers.value & layer) != 0);
        }

        /// <summary>The enabled ones of the open scenes, sorted by name.</summary>
        public static IReadOnlyList<T> All<T>()
            where T : Behaviour => AllOfThem<T>().Where(each => each.isActiveAndEnabled).ToArray();

        private static IReadOnlyList<T> AllOfThem<T>()
            where T : Behaviour => Object.FindObjectsByType<T>(FindObjectsInactive.Include, FindObjectsSortMode.None)
            .OrderBy(each => each.name, StringComparer.Ordinal)
            .ToArray();
    }

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
