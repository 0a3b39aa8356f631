#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Colliders without a label, and kinds of colliders that are felt with limits.</summary>
    internal static class ColliderRules
    {
        private const int MostNames = 8;

        public static IEnumerable<Finding> Check(SceneContents scene)
        {
            // What a rule decides, be it for nothing, needs no tag.
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
                    $"Not tagged, and no name suggests a label: {Names(plan.Unmatched)}.", plan.Unmatched);
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
                    $"Mesh colliders without a mesh, which nothing can touch: {Names(empty)}.", empty);
            }
            List<GameObject> hollow = meshes
                .Where(mesh => mesh.sharedMesh != null && !mesh.convex).Select(Owner).ToList();
            if (hollow.Count > 0)
            {
                yield return new Finding(MessageType.Info,
                    $"Not convex, and so met from the front of their faces: {Names(hollow)}. A tip deeper than " +
                    $"{1000.0 * RayProbe.DeepestMetres:0} mm behind a face counts as outside, faces are not felt " +
                    "from behind, and one that a script moves without a rigid body is felt where the last physics " +
                    "step had it. Boxes, spheres and capsules are exact.", hollow);
            }
        }

        private static GameObject Owner(Collider collider) => collider.gameObject;

        private static string Names(IReadOnlyCollection<GameObject> objects)
        {
            string names = string.Join(", ", objects.Take(MostNames).Select(each => each.name));
            return objects.Count <= MostNames ? names : $"{names} and {objects.Count - MostNames} more";
        }
    }
}
