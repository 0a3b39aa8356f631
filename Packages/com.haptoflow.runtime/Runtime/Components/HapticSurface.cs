#nullable enable
using System;
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Assigns a material to the colliders of a GameObject, so that styluses can feel them.</summary>
    /// <remarks>Box, sphere, capsule and character colliders are computed exactly, and so are convex meshes for a tip
    /// outside of them. Other mesh and terrain colliders are searched with rays against their front faces, whatever
    /// Physics.queriesHitBackfaces is: a tip more than 20 mm behind a face counts as outside. Triggers and wheel
    /// colliders are ignored.</remarks>
    [AddComponentMenu("HaptoFlow/Haptic Surface")]
    [DisallowMultipleComponent]
    [HelpPage(HelpPages.Components + "haptic-surface")]
    public sealed class HapticSurface : MonoBehaviour
    {
        private const int MinimumBeforeSweep = 64;

        [SerializeField, Tooltip("The shared material is a Haptic Material asset that several surfaces may use. When " +
            "it is empty, the surface has the material described below.")]
        private HapticMaterial? sharedMaterial;

        [SerializeField]
        private MaterialDescription own = new MaterialDescription();

        [SerializeField, Tooltip("The surface includes the colliders of child objects, except for those below " +
            "another Haptic Surface.")]
        private bool includeChildren = true;

        [SerializeField, Tooltip("The velocity of the tip is measured relative to the moving object; when it is off, " +
            "relative to the world.")]
        private bool feelOwnMotion = true;

        [SerializeField, Tooltip("The grain is the direction of the first tangent axis in the object's local space, " +
            "for example along the grain of wood.")]
        private Vector3 grain = new Vector3(1f, 0f, 0f);

        [SerializeField, Tooltip("The mask selects further materials by a texture at the touched point. It works on " +
            "readable mesh colliders that are not convex. It may be empty.")]
        private HapticMaskMap? mask;

        [SerializeField, Tooltip("The tip follows the heights of this relief. It works on boxes, terrains, and " +
            "readable mesh colliders that are not convex. It may be empty.")]
        private HapticRelief? relief;

        [SerializeField, Tooltip("The seed says where the surface's asperities lie: surfaces with different numbers " +
            "differ. At 0 the object's place in the hierarchy decides.")]
        private uint seed;

        [SerializeField, Range(0f, 1f), Tooltip("The variation is how much this object differs from other objects " +
            "with the same label, at most as much as the recorded pieces did. The seed says in what it differs.")]
        private float variation;

        private static readonly Predicate<Collider> IsDestroyed = collider => collider == null;
        private readonly List<Collider> registered = new List<Collider>();
        private int sweepAt;
        private bool isStale;
        private readonly MaterialLookUp ownLookUp = new MaterialLookUp();

        /// <summary>The shared material asset; null where the surface has a description of its own. A change to the
        /// asset affects every surface that shares it, as with Renderer.sharedMaterial.</summary>
        public HapticMaterial? SharedMaterial
        {
            get => sharedMaterial;
            set
            {
                sharedMaterial = value;
                HapticSession.Existing?.Prepare(SharedDescription);
            }
        }

        /// <summary>The description of this surface alone, for changes. As with Renderer.material, reading this
        /// property replaces a shared material by a copy, and <see cref="SharedMaterial"/> is null from then on. To
        /// read only, use <see cref="SharedDescription"/>.</summary>
        public MaterialDescription Material
        {
            get
            {
                if (IsShared)
                {
                    own.CopyFrom(sharedMaterial!.Description);
                    sharedMaterial = null;
                }
                return own;
            }
        }

        /// <summary>The description in effect, for reading: the shared material's, or the surface's own. A change to a
        /// shared one affects the asset and every surface that shares it.</summary>
        public MaterialDescription SharedDescription => IsShared ? sharedMaterial!.Description : own;

        /// <summary>True to include colliders of children.</summary>
        public bool IncludeChildren
        {
            get => includeChildren;
            set
            {
                includeChildren = value;
                MarkStale();
            }
        }

        /// <summary>True to take the tip's velocity relative to the object; false to take it relative to the
        /// world.</summary>
        public bool FeelOwnMotion { get => feelOwnMotion; set => feelOwnMotion = value; }

        /// <summary>Direction of the first tangent axis, in the object's local space.</summary>
        public Vector3 Grain { get => grain; set => grain = value; }

        /// <summary>A texture that blends in further materials at the touched place; null for none.</summary>
        public HapticMaskMap? Mask { get => mask; set => mask = value; }

        /// <summary>The heights that the tip follows; null for none. The effect <see cref="HapticEffects.Relief"/> is
        /// on where there is one, and costs nothing elsewhere.</summary>
        public HapticRelief? Relief
        {
            get => relief;
            set
            {
                relief = value;
                HapticSession.Existing?.Prepare(value);
            }
        }

        /// <summary>How much this object differs from other objects with the same label, 0 to 1: at 0 all of them are
        /// the label's mean, at 1 they differ as the recorded pieces of that label did. The seed says which object this
        /// is, the same in every session; of a surface with colliders on several objects, each is one of its own. It
        /// has no effect on learnt materials and with a model that does not tell pieces apart.</summary>
        public float Variation { get => variation; set => variation = Mathf.Clamp01(value); }

        /// <summary>Says where the surface's asperities lie: the same place of surfaces with the same number and
        /// material feels the same, in every session, and surfaces with different numbers differ. At 0, the value of
        /// components added by scripts of a running scene, the collider's place in the hierarchy decides.</summary>
        /// <remarks>The editor gives each component, and each copy, a number of its own. A copy made while the scene
        /// runs has its original's until this property is set. A change applies when a tip next comes near. Main
        /// thread.</remarks>
        public uint Seed { get => seed; set => seed = value; }

        /// <summary>Colliders that belong to this surface. Direct children that come or go, and colliders added deeper
        /// below, are detected automatically.</summary>
        public IReadOnlyList<Collider> Colliders
        {
            get
            {
                if (isStale)
                {
                    Refresh();
                }
                registered.RemoveAll(IsDestroyed);
                return registered;
            }
        }

        /// <summary>Searches for colliders again now. Needed only so that <see cref="Colliders"/> lists a change deeper
        /// in the hierarchy before a tip comes near. Main thread; makes garbage.</summary>
        public void Refresh()
        {
            Unregister();
            if (isActiveAndEnabled)
            {
                Register();
            }
        }

        /// <summary>True where the collider lies in this surface's part of the hierarchy, unless a nearer surface has
        /// it.</summary>
        internal bool Reaches(Collider collider) => includeChildren
            ? collider.transform.IsChildOf(transform)
            : ReferenceEquals(collider.gameObject, gameObject);

        /// <summary>True where a registered collider still belongs to this surface.</summary>
        internal bool Keeps(Collider collider) => !isStale && Reaches(collider);

        internal void Adopt(Collider collider)
        {
            if (isStale)
            {
                Refresh();
            }
            if (SurfaceRegistry.IsOf(collider, this))
            {
                return;
            }
            if (registered.Count >= sweepAt)
            {
                registered.RemoveAll(IsDestroyed);
                sweepAt = Math.Max(MinimumBeforeSweep, 2 * registered.Count);
            }
            registered.Add(collider);
            SurfaceRegistry.Add(collider, this);
        }

        internal void Disown(Collider collider) => registered.Remove(collider);

        /// <summary>The material at a place on one of the colliders; without labels where the place has none.</summary>
        internal ResolvedMaterial At(in TouchedPlace place, HapticSession session)
        {
            ResolvedMaterial whole = ResolvedMaterial.Of(SharedDescription, LookUp(session));
            if (mask != null && mask.TryFeel(place, whole, session, this, out ResolvedMaterial felt))
            {
                whole = felt;
            }
            whole.Variation = variation;
            whole.Relief = relief != null ? relief : null;
            return whole;
        }

        // A shared material that was unloaded is not replaced by the surface's own description.
        private bool IsShared => sharedMaterial != null || HapticMaterial.IsUnloaded(sharedMaterial);

        /// <summary>Labels and stiffness for the engine, looked up again only after a change.</summary>
        internal MaterialLookUp LookUp(HapticSession session) => IsShared
            ? sharedMaterial!.LookUp(session, this)
            : ownLookUp.Of(own, session, this);

        // Unity calls it only in the editor, for a new component and for Reset in its menu.
        private void Reset() => seed = SurfaceSeeds.New();

        private void OnEnable()
        {
            Register();
            SurfaceRegistry.Changed();
            InvalidateSurfaceAbove();
            HapticSession.Existing?.Prepare(SharedDescription);
            HapticSession.Existing?.Prepare(relief);
        }

        private void OnDisable() => Unregister();

        private void OnDestroy() => InvalidateSurfaceAbove();

        // Unity reports direct children only; changes deeper below are detected when a tip comes near.
        private void OnTransformChildrenChanged() => MarkStale();

        private void OnValidate()
        {
            own.MarkChanged();
            MarkStale();
        }

        private void MarkStale()
        {
            isStale = true;
            SurfaceRegistry.Changed();
        }

        /// <summary>Makes the surface above search again: colliders here belonged to it, or will.</summary>
        private void InvalidateSurfaceAbove()
        {
            HapticSurface? above = SurfaceRegistry.OwnerOf(transform.parent);
            if (above != null)
            {
                above.isStale = true;
            }
        }

        private void Register()
        {
            isStale = false;
            if (includeChildren)
            {
                GetComponentsInChildren(true, registered);
                registered.RemoveAll(candidate => SurfaceRegistry.OwnerOf(candidate.transform) != this);
            }
            else
            {
                GetComponents(registered);
            }
            foreach (Collider candidate in registered)
            {
                SurfaceRegistry.Add(candidate, this);
            }
        }

        private void Unregister()
        {
            foreach (Collider candidate in registered)
            {
                SurfaceRegistry.Remove(candidate, this);
            }
            registered.Clear();
        }
    }
}
