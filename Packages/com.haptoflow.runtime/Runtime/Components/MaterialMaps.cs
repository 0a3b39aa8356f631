#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Text.RegularExpressions;
using HaptoFlow.Model;
using HaptoFlow.Numerics;
using UnityEngine;
using UnityEngine.SceneManagement;

namespace HaptoFlow
{
    /// <summary>The maps in effect: those of a scene first, then the project's. Main thread.</summary>
    internal static class MaterialMaps
    {
        private static readonly List<HapticMaterialMapScope> Scopes = new List<HapticMaterialMapScope>();
        private static HapticMaterialMap? project;

        /// <summary>Increases with each change of a map, a scope, or the project's choice.</summary>
        public static int Version { get; private set; }

        public static bool Any => project is object || Scopes.Count > 0;

        public static void Change() => ++Version;

        public static void Set<T>(ref T field, T value)
        {
            field = value;
            Change();
        }

        /// <summary>Call once a frame: detects a change of the project's map, and reads terrains ahead.</summary>
        public static void Poll()
        {
            HapticMaterialMap? chosen = HaptoFlowSettings.Active.MaterialMap;
            chosen = chosen != null ? chosen : null;
            if (!ReferenceEquals(chosen, project))
            {
                project = chosen;
                Change();
            }
            TerrainWeights.Poll();
        }

        public static void Add(HapticMaterialMapScope scope)
        {
            if (!Scopes.Contains(scope))
            {
                Scopes.Add(scope);
                Reorder();
            }
        }

        public static void Remove(HapticMaterialMapScope scope)
        {
            Scopes.Remove(scope);
            Change();
        }

        public static void Reorder()
        {
            // Unlike List.Sort, OrderBy keeps the sequence of entries of equal order.
            HapticMaterialMapScope[] ordered = Scopes.OrderBy(scope => scope.Order).ToArray();
            Scopes.Clear();
            Scopes.AddRange(ordered);
            Change();
        }

        public static void CollectFor(Scene scene, List<HapticMaterialMap> maps)
        {
            maps.Clear();
            foreach (HapticMaterialMapScope scope in Scopes)
            {
                if (scope.Map != null && scope.gameObject.scene == scene)
                {
                    maps.Add(scope.Map);
                }
            }
            if (project is object && project != null)
            {
                maps.Add(project);
            }
        }

        /// <summary>Registers the learnt materials of all rules before they are touched.</summary>
        public static void PrepareAll(HapticSession session)
        {
            Poll();
            Prepare(session, project);
            foreach (HapticMaterialMapScope scope in Scopes)
            {
                Prepare(session, scope.Map);
            }
        }

        private static void Prepare(HapticSession session, HapticMaterialMap? map)
        {
            if (map == null)
            {
                return;
            }
            foreach (HapticMaterialRule rule in map.Rules)
            {
                Prepare(session, rule.Material);
                session.Prepare(rule.Relief);
            }
            Prepare(session, map.DefaultMaterial);
        }

        private static void Prepare(HapticSession session, HapticMaterial? material)
        {
            if (material != null)
            {
                session.Prepare(material.Description);
            }
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Forget()
        {
            Scopes.Clear();
            project = null;
            Change();
        }
    }

    /// <summary>Matches names against patterns in which <c>*</c> stands for any number of characters. Case is ignored.
    /// So is the form of accents: some systems write a name with them apart from their letters.</summary>
    internal static class NamePattern
    {
        // By pattern: a map is matched with many colliders.
        private static readonly Dictionary<string, Regex> Known = new Dictionary<string, Regex>();

        /// <summary>True where the pattern matches the whole name; an empty pattern matches nothing.</summary>
        public static bool Matches(string pattern, string name)
        {
            if (!Known.TryGetValue(pattern, out Regex? known))
            {
                string text = Regex.Escape(LabelSpelling.Composed(pattern)).Replace("\\*", ".*");
                known = new Regex("\\A" + text + "\\z",
                    RegexOptions.IgnoreCase | RegexOptions.CultureInvariant | RegexOptions.Singleline);
                Known.Add(pattern, known);
            }
            return pattern.Length > 0 && known.IsMatch(LabelSpelling.Composed(name));
        }
    }

    /// <summary>Blends materials by their weights into one that a contact state can carry: the four labels of largest
    /// weight. Main thread, one blend at a time; no garbage.</summary>
    internal sealed class MaterialMix
    {
        private const int MaximumLabels = 32;

        // Smaller shares, below -54 dB, cannot be felt. Rounding at the centre of a texel would add a second label.
        private const float MinimumShare = 0.002f;

        private readonly int[] labels = new int[MaximumLabels];
        private readonly float[] weights = new float[MaximumLabels];
        private int count;
        private float total;
        private float felt;
        private float strength;
        private float logFeatureScale;
        private float tone;
        private double stiffness;
        private double stiffnessWeight;
        private float heaviestWeight;
        private ResolvedMaterial heaviest;

        public static MaterialMix Shared { get; } = new MaterialMix();

        public void Begin()
        {
            count = 0;
            total = 0f;
            felt = 0f;
            strength = 0f;
            logFeatureScale = 0f;
            tone = 0f;
            stiffness = 0.0;
            stiffnessWeight = 0.0;
            heaviestWeight = 0f;
            heaviest = default;
        }

        public void Add(
            HapticMaterial? material, HapticSession session, UnityEngine.Object user, float weight, int part) =>
            Add(ResolvedMaterial.Of(material, session, user), weight, part);

        /// <summary>Adds a share of a material. One without known labels counts as no material, which weakens the
        /// rest.</summary>
        public void Add(in ResolvedMaterial material, float weight, int part)
        {
            weight = Usable(weight);
            total += weight;
            if (weight <= 0f || material.Labels.Count == 0)
            {
                return;
            }
            felt += weight;
            strength += weight * material.Strength;
            logFeatureScale += weight * (float)Math.Log(material.FeatureScale > 0f ? material.FeatureScale : 1f);
            tone += weight * material.ToneDbPerOctave;
            if (material.StiffnessNewtonsPerMetre > 0.0)
            {
                stiffness += weight * material.StiffnessNewtonsPerMetre;
                stiffnessWeight += weight;
            }
            for (int index = 0; index < material.Labels.Count; ++index)
            {
                AddLabel(material.Labels.Label(index), weight * material.Labels.Weight(index));
            }
            if (weight > heaviestWeight)
            {
                heaviestWeight = weight;
                heaviest = material;
                heaviest.Part = part;
            }
        }

        /// <summary>The blend: weighted means, except for the effects, which are those of the material of largest
        /// weight.</summary>
        public ResolvedMaterial Finish()
        {
            if (felt <= 0f)
            {
                return default;
            }
            ResolvedMaterial mixed = heaviest;
            mixed.Labels = HeaviestLabels();
            mixed.Strength = strength / total;
            mixed.FeatureScale = (float)Math.Exp(logFeatureScale / felt);
            mixed.ToneDbPerOctave = tone / felt;
            mixed.StiffnessNewtonsPerMetre = stiffnessWeight > 0.0 ? stiffness / stiffnessWeight : 0.0;
            return mixed;
        }

        private static float Usable(float weight) => weight > 0f && !float.IsInfinity(weight) ? weight : 0f;

        private void AddLabel(int label, float weight)
        {
            for (int index = 0; index < count; ++index)
            {
                if (labels[index] == label)
                {
                    weights[index] += weight;
                    return;
                }
            }
            if (count < MaximumLabels)
            {
                labels[count] = label;
                weights[count] = weight;
                ++count;
            }
        }

        private LabelBlend HeaviestLabels()
        {
            int most = Math.Min(count, LabelBlend.Maximum);
            for (int place = 0; place < most; ++place)
            {
                int best = place;
                for (int index = place + 1; index < count; ++index)
                {
                    best = weights[index] > weights[best] ? index : best;
                }
                (labels[place], labels[best]) = (labels[best], labels[place]);
                (weights[place], weights[best]) = (weights[best], weights[place]);
            }
            int kept = 0;
            float sum = 0f;
            for (; kept < most && weights[kept] >= MinimumShare * felt; ++kept)
            {
                sum += weights[kept];
            }
            var blend = default(LabelBlend);
            for (int place = 0; place < kept; ++place)
            {
                blend.Add(labels[place], weights[place] / sum);
            }
            return blend;
        }
    }

    /// <summary>The material at one place: the part of a contact state that describes it.</summary>
    internal struct ResolvedMaterial
    {
        public LabelBlend Labels;

        public float Strength;

        public float FeatureScale;

        public float ToneDbPerOctave;

        /// <summary>Of the object, not of its material.</summary>
        public float Variation;

        public HapticEffects Effects;

        /// <summary>Of the object, not of its material; null for none.</summary>
        public HapticRelief? Relief;

        /// <summary>Stiffness in N/m; 0 for the contact model's default.</summary>
        public double StiffnessNewtonsPerMetre;

        /// <summary>Description of the material with the largest weight; null where the place has none.</summary>
        public MaterialDescription? Heaviest;

        /// <summary>The submesh or terrain layer with the largest weight.</summary>
        public int Part;

        /// <summary>The material under a hand whose metre is another than the world's: its features keep their size in
        /// the world, as far as the engine can scale them.</summary>
        /// <param name="scale">Metres of the world for a metre of the hand.</param>
        public ResolvedMaterial On(double scale)
        {
            ResolvedMaterial material = this;
            material.FeatureScale = scale == 1.0
                ? FeatureScale
                : (float)Vectors.Clamp(FeatureScale / scale, MaterialDescription.MinimumFeatureScale,
                    MaterialDescription.MaximumFeatureScale);
            return material;
        }

        /// <summary>A single material; one without labels for null.</summary>
        public static ResolvedMaterial Of(HapticMaterial? material, HapticSession session, UnityEngine.Object user) =>
            material is object ? Of(material.Description, material.LookUp(session, user)) : default;

        public static ResolvedMaterial Of(MaterialDescription description, MaterialLookUp lookUp) => new ResolvedMaterial
        {
            Labels = lookUp.Labels,
            Strength = description.Strength,
            FeatureScale = description.FeatureScale,
            ToneDbPerOctave = description.ToneDbPerOctave,
            Effects = description.Effects,
            StiffnessNewtonsPerMetre = lookUp.StiffnessNewtonsPerMetre,
            Heaviest = description,
        };
    }
}
