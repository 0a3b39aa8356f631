#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
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

        /// <summary>The material maps in use.</summary>
        public SceneMaps Maps { get; }

        /// <summary>What each of <see cref="Colliders"/> feels like, and why.</summary>
        public IReadOnlyList<ColliderMaterial> Answers { get; }

        private bool IsInReach(Collider collider)
        {
            int layer = 1 << collider.gameObject.layer;
            return Styluses.Count == 0 || Styluses.Any(stylus => (stylus.Layers.value & layer) != 0);
        }

        private static IReadOnlyList<T> All<T>()
            where T : Behaviour => AllOfThem<T>().Where(each => each.isActiveAndEnabled).ToArray();

        private static IReadOnlyList<T> AllOfThem<T>()
            where T : Behaviour => Object.FindObjectsByType<T>(FindObjectsInactive.Include, FindObjectsSortMode.None)
            .OrderBy(each => each.name, StringComparer.Ordinal)
            .ToArray();
    }
}
