#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>An object that can be tagged, with the label that its name or physics material suggests.</summary>
    /// <param name="Reason">What suggests the label: "name" or the physics material.</param>
    internal sealed record TagProposal(GameObject Owner, string Label, string Reason);

    /// <summary>The labels proposed for untagged colliders. Creating a plan changes no object.</summary>
    internal sealed class TagPlan
    {
        private readonly List<TagProposal> proposals = new List<TagProposal>();
        private readonly List<GameObject> unmatched = new List<GameObject>();
        private readonly HashSet<GameObject> decided = new HashSet<GameObject>();
        private readonly LabelMatcher matcher;

        private TagPlan(LabelMatcher matcher) => this.matcher = matcher;

        public IReadOnlyList<TagProposal> Proposals => proposals;

        /// <summary>Objects with untagged colliders for which nothing suggests a label.</summary>
        public IReadOnlyList<GameObject> Unmatched => unmatched;

        /// <summary>Plans a label for every untagged collider. The physics material is compared first, then the name of
        /// the object, then the names of its parents up to a root.</summary>
        /// <param name="roots">Parents above these objects are not compared.</param>
        public static TagPlan For(
            IEnumerable<Collider> colliders, IReadOnlyCollection<GameObject> roots, LabelMatcher matcher)
        {
            var plan = new TagPlan(matcher);
            foreach (Collider collider in colliders.Where(each => SceneColliders.SurfaceOf(each) == null))
            {
                plan.Decide(collider, roots);
            }
            return plan;
        }

        private void Decide(Collider collider, IReadOnlyCollection<GameObject> roots)
        {
            GameObject owner = collider.gameObject;
            Object? physics = collider.sharedMaterial;
            string? label = physics != null ? matcher.Propose(physics!.name) : null;
            if (label != null)
            {
                Add(owner, label, $"physics material {physics!.name}");
                return;
            }
            for (Transform? place = owner.transform; place != null; place = place.parent)
            {
                label = matcher.Propose(place.name);
                if (label != null)
                {
                    Add(place.gameObject, label, "name");
                    return;
                }
                if (roots.Contains(place.gameObject))
                {
                    break;
                }
            }
            if (decided.Add(owner))
            {
                unmatched.Add(owner);
            }
        }

        private void Add(GameObject owner, string label, string reason)
        {
            if (decided.Add(owner))
            {
                proposals.Add(new TagProposal(owner, label, reason));
            }
        }
    }
}
