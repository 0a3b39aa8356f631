#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
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
}
