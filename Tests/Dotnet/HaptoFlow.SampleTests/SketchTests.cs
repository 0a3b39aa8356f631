using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.SampleScenes;
using HaptoFlow.Samples.LatencyStudy;
using HaptoFlow.Samples.SimilarityStudy;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    /// <summary>What the scene view shows of a sample before play mode is what play mode builds.</summary>
    public sealed class SketchTests : SampleTest
    {
        [SetUp]
        public void Clear() => Gizmos.Solids.Clear();

        [Test]
        public void StylusTracingSketchesItsObjects() => Check<TracingScene>("StylusTracing", 8);

        [Test]
        public void TextureGallerySketchesATileForEachLabelAndTheBoard() => Check<GalleryScene>("TextureGallery", 21);

        [Test]
        public void WorkshopSketchesItsBench() => Check<WorkshopScene>("Workshop", 6);

        [Test]
        public void DeviceCheckSketchesItsPlates() => Check<DeviceCheckScene>("DeviceCheck", 3);

        [Test]
        public void LatencyStudySketchesItsPlate() => Check<LatencyStudyScene>("LatencyStudy", 1);

        [Test]
        public void SimilarityStudySketchesBothObjectsAndNothingWithoutSettings()
        {
            GameObject owner = Make("Bootstrap");
            owner.SetActive(false);
            var scene = owner.AddComponent<SimilarityStudyScene>();
            scene.Sketch();
            Assert.That(Gizmos.Solids, Is.Empty);
            var settings = ScriptableObject.CreateInstance<SimilarityStudySettings>();
            scene.Settings = settings;
            scene.Sketch();
            Assert.That(Gizmos.Solids, Has.Count.EqualTo(2));
            Assert.That(Gizmos.Solids.Select(solid => solid.Size), Is.All.EqualTo(settings.SampleMetres));
            Assert.That(Gizmos.Solids[1].Position - Gizmos.Solids[0].Position, Is.EqualTo(settings.VirtualMetres));
        }

        private void Check<TScene>(string sample, int solids)
            where TScene : BuiltScene
        {
            Camera camera = CameraOf(new SceneFile(sample));
            camera.gameObject.AddComponent<AudioListener>();
            TScene scene = Wake<TScene>(each =>
            {
                each.View = camera;
                each.Sketch();
            });
            Assert.That(Gizmos.Solids, Has.Count.EqualTo(solids));
            Extent[] built = World.AllObjects
                .Select(each => each.TryGetComponent(out Collider collider) ? collider : null)
                .Where(each => each != null && each.enabled).Select(each => Extent.Of(each!)).ToArray();
            foreach ((Vector3 position, Quaternion _, Vector3 size, Color _) in Gizmos.Solids)
            {
                Assert.That(built.Any(each => each.Is(position, size)), Is.True, $"{scene.name}: {position}, {size}");
            }
        }

        private readonly struct Extent
        {
            private readonly Vector3 centre;
            private readonly Vector3 size;

            private Extent(Vector3 centre, Vector3 size)
            {
                this.centre = centre;
                this.size = size;
            }

            public static Extent Of(Collider collider)
            {
                Transform place = collider.transform;
                switch (collider)
                {
                    case MeshCollider mesh:
                        IEnumerable<Vector3> corners = mesh.sharedMesh!.vertices;
                        var least = new Vector3(
                            corners.Min(each => each.x), corners.Min(each => each.y), corners.Min(each => each.z));
                        var most = new Vector3(
                            corners.Max(each => each.x), corners.Max(each => each.y), corners.Max(each => each.z));
                        return new Extent(place.position + 0.5f * (least + most), most - least);
                    case TerrainCollider terrain:
                        Vector3 whole = terrain.terrainData!.size;
                        return new Extent(place.position + 0.5f * whole, whole);
                    default:
                        Vector3 scale = place.localScale;
                        // Unity's capsule is two units high.
                        return new Extent(place.position,
                            collider is CapsuleCollider ? new Vector3(scale.x, 2f * scale.y, scale.z) : scale);
                }
            }

            /// <summary>True for a solid of the same outline and the same top: a felt sheet has no height.</summary>
            public bool Is(Vector3 otherCentre, Vector3 otherSize) =>
                Vector3.Distance(Top(centre, size), Top(otherCentre, otherSize)) < 1e-4f &&
                Math.Abs(size.x - otherSize.x) < 1e-3f && Math.Abs(size.z - otherSize.z) < 1e-3f;

            private static Vector3 Top(Vector3 centre, Vector3 size) => centre + new Vector3(0f, 0.5f * size.y, 0f);
        }
    }
}
