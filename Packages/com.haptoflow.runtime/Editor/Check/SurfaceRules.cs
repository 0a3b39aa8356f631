#nullable enable
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Checks that every surface has labels of the model, and a collider that can be felt.</summary>
    internal static class SurfaceRules
    {
        public static IEnumerable<Finding> Check(SceneContents scene)
        {
            LabelCatalog catalog = LabelCatalog.Current;
            var seen = new HashSet<Object>();
            foreach (HapticSurface surface in scene.Surfaces)
            {
                // A material that several surfaces share is checked once.
                HapticMaterial? shared = surface.SharedMaterial;
                Object owner = shared != null ? (Object)shared : surface;
                if (seen.Add(owner))
                {
                    string root = shared != null ? "description." : "own.";
                    MaterialDescription material = surface.SharedDescription;
                    foreach (Finding finding in CheckLabels(catalog, owner, material, root))
                    {
                        yield return finding;
                    }
                }
                bool canBeFelt = SceneColliders.Below(new[] { surface.gameObject })
                    .Any(collider => SceneColliders.SurfaceOf(collider) == surface);
                if (!canBeFelt)
                {
                    yield return new Finding(MessageType.Warning,
                        $"{surface.name} is tagged, but has no collider that can be felt. Add a box, sphere, " +
                        "capsule, character, mesh or terrain collider that is enabled and no " +
                        "trigger.", new[] { surface });
                }
            }
        }

        internal static IEnumerable<Finding> CheckLabels(
            LabelCatalog catalog, Object owner, MaterialDescription material, string root)
        {
            if (material.Label.Length == 0 && material.SecondLabel.Length == 0)
            {
                yield return new Finding(MessageType.Warning, $"{owner.name} has no label: it is not felt.",
                    new[] { owner });
            }
            if (catalog.IsUnknown(material.Label))
            {
                yield return Unknown(catalog, owner, material.Label, root + "label");
            }
            if (catalog.IsUnknown(material.SecondLabel))
            {
                yield return Unknown(catalog, owner, material.SecondLabel, root + "secondLabel");
            }
        }

        private static Finding Unknown(LabelCatalog catalog, Object owner, string label, string path)
        {
            IReadOnlyList<string> near = catalog.Names.NearMatches(label);
            string remedy = near.Count > 0
                ? "near matches: " + string.Join(", ", near)
                : "its labels are: " + string.Join(", ", catalog.Names.All);
            Repair[] repairs = near
                .Select(name => new Repair($"Use \"{name}\"", () => SetLabel(owner, path, name)))
                .ToArray();
            return new Finding(MessageType.Warning,
                $"{owner.name}: the model has no label \"{label}\"; {remedy}.", new[] { owner }, repairs);
        }

        private static void SetLabel(Object owner, string path, string label) =>
            SerializedFields.Set(owner, path, property => property.stringValue = label);
    }

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

    /// <summary>Finds colliders without a label, and kinds of colliders with limits.</summary>
    internal static class ColliderRules
    {
        public static IEnumerable<Finding> Check(SceneContents scene)
        {
            // A collider that a rule matches needs no tag, not even if the rule assigns no material.
            Collider[] undecided = scene.Answers
                .Where(answer => answer.ByRules.Parts.All(part => part.Map is null))
                .Select(answer => answer.Collider).ToArray();
            var plan = TagPlan.For(
                undecided, new HashSet<GameObject>(), new LabelMatcher(LabelCatalog.Current.Names));
            foreach (TagProposal proposal in plan.Proposals)
            {
                yield return new Finding(MessageType.Info,
                    $"{proposal.Owner.name} is not tagged; its {proposal.Reason} suggests {proposal.Label}.",
                    new[] { proposal.Owner },
                    new Repair($"Tag as {proposal.Label}", () => Tagging.Apply(new[] { proposal }, "Tag")));
            }
            if (plan.Unmatched.Count > 0)
            {
                yield return new Finding(MessageType.Info,
                    $"Not tagged, and no name suggests a label: {MaterialWords.Names(plan.Unmatched)}.", plan.Unmatched);
            }
            foreach (Finding finding in CheckMeshes(scene))
            {
                yield return finding;
            }
        }

        private static IEnumerable<Finding> CheckMeshes(SceneContents scene)
        {
            List<MeshCollider> meshes = scene.Answers.Where(answer => answer.CanBeFelt)
                .Select(answer => answer.Collider).OfType<MeshCollider>().ToList();
            List<GameObject> empty = meshes.Where(mesh => mesh.sharedMesh == null).Select(Owner).ToList();
            if (empty.Count > 0)
            {
                yield return new Finding(MessageType.Warning,
                    $"These mesh colliders have no mesh and cannot be touched: {MaterialWords.Names(empty)}.", empty);
            }
            List<GameObject> concave = meshes
                .Where(mesh => mesh.sharedMesh != null && !mesh.convex).Select(Owner).ToList();
            if (concave.Count > 0)
            {
                yield return new Finding(MessageType.Info,
                    "These mesh colliders are not convex, so only the front of their faces is felt: " +
                    $"{MaterialWords.Names(concave)}. A tip more than {1000.0 * RayProbe.MaximumDepthMetres:0} mm behind a " +
                    "face counts as outside. A mesh that a script moves without a rigid body is felt where the last " +
                    "physics step placed it. Boxes, spheres and capsules are exact.", concave);
            }
        }

        private static GameObject Owner(Collider collider) => collider.gameObject;
    }

    /// <summary>Reports which effects the scene uses, and the measured cost of each on this machine since play mode
    /// began. An effect that nothing uses does not run.</summary>
    internal static class EffectRules
    {
        private static readonly (HapticEffects Flag, HapticEffect Effect, string Name)[] OfSurfaces =
        {
            (HapticEffects.Texture, HapticEffect.Texture, "texture"),
            (HapticEffects.Impact, HapticEffect.Impact, "impact"),
            (HapticEffects.Edge, HapticEffect.Edge, "edge"),
        };

        public static IEnumerable<Finding> Check(SceneContents scene)
        {
            if (Descriptions(scene).Any() && UsedEffects(scene).Count == 0)
            {
                yield return new Finding(MessageType.Warning,
                    "No surface has an effect: nothing is felt. Switch on Texture, Impact or Edge on a surface, " +
                    "or give it a relief.");
            }
        }

        /// <summary>The effects in use and their cost, as text; empty when nothing uses an effect.</summary>
        public static string Summary(SceneContents scene)
        {
            List<string> used = UsedEffects(scene);
            if (used.Count == 0)
            {
                return "";
            }
            string cost = HasRun(scene) ? "" : " Play the scene once to see what each costs on this machine.";
            return $"The scene uses {string.Join(", ", used)}. No other effect runs.{cost}";
        }

        private static List<string> UsedEffects(SceneContents scene)
        {
            var used = new List<string>();
            foreach ((HapticEffects flag, HapticEffect effect, string name) in OfSurfaces)
            {
                int count = Descriptions(scene).Count(material => (material.Effects & flag) != 0);
                Add(used, name, count, "surface", Cost(scene, effect));
            }
            Add(used, "relief", ReliefRules.Uses(scene).Count(), "collider", Cost(scene, HapticEffect.Relief));
            Add(used, "compensation",
                scene.Outputs.Count(output => output.Processing.Actuator != OutputActuator.Uncompensated), "output",
                Cost(scene, HapticEffect.Compensation));
            Add(used, "exposure guard", scene.Outputs.Count(output => output.Processing.ExposureGuard),
                "output", Cost(scene, HapticEffect.ExposureGuard));
            Add(used, "delay", scene.Outputs.Count(output => output.Processing.DelayMilliseconds > 0f),
                "output", Cost(scene, HapticEffect.Delay));
            return used;
        }

        /// <summary>The materials of all surfaces, and of the colliders to which a rule assigns a material.</summary>
        private static IEnumerable<MaterialDescription> Descriptions(SceneContents scene) => scene.Surfaces
            .Select(surface => surface.SharedDescription)
            .Concat(scene.Answers.Where(answer => answer.Surface is null && answer.CanBeFelt)
                .Select(answer => answer.ByRules.Parts.First(part => part.CanBeFelt).Material?.Description)
                .Where(description => description != null).Select(description => description!));

        private static bool HasRun(SceneContents scene) =>
            OfSurfaces.Any(each => Cost(scene, each.Effect).HasValue);

        private static void Add(List<string> used, string name, int count, string noun, double? microseconds)
        {
            if (count > 0)
            {
                string cost = microseconds.HasValue ? FormattableCost(microseconds.Value) : "";
                used.Add($"{name} ({count} {noun}{(count == 1 ? "" : "s")}{cost})");
            }
        }

        private static string FormattableCost(double microseconds) =>
            System.FormattableString.Invariant($", {microseconds:0.0} us a run");

        /// <summary>The mean time of a run over all styluses, in microseconds; null before the first run.</summary>
        private static double? Cost(SceneContents scene, HapticEffect effect)
        {
            double microseconds = 0.0;
            ulong runs = 0;
            foreach (HapticStylus stylus in scene.Styluses)
            {
                if (stylus.TryGetEffectStatistics(effect, out EffectStatistics statistics))
                {
                    microseconds += statistics.Microseconds;
                    runs += statistics.Runs;
                }
            }
            return runs > 0 ? microseconds / runs : (double?)null;
        }
    }
}
