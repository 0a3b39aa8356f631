#nullable enable
using System;
using System.Collections.Generic;
using NUnit.Framework;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Tests
{
    /// <summary>Moves an object along a path, given as a function of the seconds since its first frame.</summary>
    internal sealed class PathMover : MonoBehaviour
    {
        private double beganSeconds = double.NaN;

        public Func<double, Vector3>? Path { get; set; }

        public double Seconds => double.IsNaN(beganSeconds) ? 0.0 : Time.unscaledTimeAsDouble - beganSeconds;

        private void Update()
        {
            if (double.IsNaN(beganSeconds))
            {
                beganSeconds = Time.unscaledTimeAsDouble;
            }
            if (Path != null)
            {
                transform.position = Path(Seconds);
            }
        }
    }

    /// <summary>Moves a kinematic body at physics steps, as games move platforms.</summary>
    internal sealed class PlatformMover : MonoBehaviour
    {
        private Rigidbody body = null!;
        private double beganSeconds;

        public Func<double, Vector3>? Path { get; set; }

        public static PlatformMover On(GameObject owner, RigidbodyInterpolation interpolation, Func<double, Vector3> path)
        {
            var body = owner.AddComponent<Rigidbody>();
            body.isKinematic = true;
            body.interpolation = interpolation;
            var mover = owner.AddComponent<PlatformMover>();
            mover.body = body;
            mover.beganSeconds = Time.fixedTimeAsDouble;
            mover.Path = path;
            return mover;
        }

        private void FixedUpdate() => body.MovePosition(Path!(Time.fixedTimeAsDouble - beganSeconds));
    }

    /// <summary>Counts a stylus's events and keeps the last contacts.</summary>
    internal sealed class TouchLog
    {
        public TouchLog(HapticStylus stylus)
        {
            stylus.TouchBegan += (HapticStylus _, in HapticContact contact) =>
            {
                ++Began;
                Last = contact;
            };
            stylus.TouchMoved += (HapticStylus _, in HapticContact contact) =>
            {
                ++Moved;
                Last = contact;
            };
            stylus.TouchEnded += (HapticStylus _, in HapticContact contact) => ++Ended;
        }

        public int Began { get; private set; }

        public int Moved { get; private set; }

        public int Ended { get; private set; }

        public HapticContact Last { get; private set; }
    }

    /// <summary>A force that a test sets.</summary>
    internal sealed class FixedForce : TipForceSource
    {
        public float ForceNewtons { get; set; }

        public bool HasNews { get; set; } = true;

        public override bool TryRead(out float forceNewtons)
        {
            forceNewtons = ForceNewtons;
            return HasNews;
        }
    }

    /// <summary>A scene whose project has a map without rules. Assets created by a test are destroyed after
    /// it.</summary>
    public abstract class MapTest : SceneTest
    {
        internal HapticMaterialMap Map { get; private set; } = null!;

        [SetUp]
        public void LoadAndGiveTheProjectAMap()
        {
            Map = MapNamed("Project");
            HaptoFlowSettings.Active.MaterialMap = Map;
            FinishLoading();
        }

        internal HapticMaterialMap MapNamed(string name)
        {
            HapticMaterialMap map = Keep(ScriptableObject.CreateInstance<HapticMaterialMap>());
            map.name = name;
            return map;
        }

        /// <summary>A renderer's material.</summary>
        internal Material Paint(string name)
        {
            GameObject sphere = GameObject.CreatePrimitive(PrimitiveType.Sphere);
            Material paint = Keep(new Material(sphere.GetComponent<MeshRenderer>().sharedMaterial!) { name = name });
            Object.DestroyImmediate(sphere);
            return paint;
        }

        /// <summary>A board like that of <see cref="SceneTest.Board"/>, without a surface.</summary>
        internal BoxCollider Bare(string name = "Plank")
        {
            var box = Make(name).AddComponent<BoxCollider>();
            box.size = new Vector3(0.4f, 0.02f, 0.4f);
            box.center = new Vector3(0f, -0.01f, 0f);
            return box;
        }

        /// <summary>A stylus at rest 1 mm deep in the board.</summary>
        internal HapticStylus Resting(float x = 0f, float z = 0f) => StylusAlong(_ => new Vector3(x, 0.001f, z));

        /// <summary>The labels at the tip with their weights, in order of weight.</summary>
        internal static List<(string Label, float Weight)> Felt(HapticStylus stylus)
        {
            var felt = new List<(string, float)>();
            LabelBlend blend = stylus.IsTouching ? stylus.Contact.Labels : default;
            for (int index = 0; index < blend.Count; ++index)
            {
                felt.Add((HapticSession.Current.Labels.All[blend.Label(index)], blend.Weight(index)));
            }
            return felt;
        }

        internal static string FeltAlone(HapticStylus stylus)
        {
            List<(string Label, float Weight)> felt = Felt(stylus);
            Assert.That(felt, Has.Count.LessThanOrEqualTo(1));
            return felt.Count == 0 ? "" : felt[0].Label;
        }
    }

    internal static class TestMeshes
    {
        /// <summary>A closed box around the origin with outward front faces.</summary>
        public static Mesh Box(float size)
        {
            float half = 0.5f * size;
            return MeshOf(
                new[]
                {
                    new Vector3(-half, -half, -half), new Vector3(half, -half, -half), new Vector3(half, half, -half),
                    new Vector3(-half, half, -half), new Vector3(-half, -half, half), new Vector3(half, -half, half),
                    new Vector3(half, half, half), new Vector3(-half, half, half),
                },
                new[]
                {
                    0, 3, 2, 0, 2, 1, 4, 5, 6, 4, 6, 7, 0, 4, 7, 0, 7, 3,
                    1, 2, 6, 1, 6, 5, 3, 7, 6, 3, 6, 2, 0, 1, 5, 0, 5, 4,
                });
        }

        /// <summary>A gutter along z, open upwards: a floor of 2 cm at y = 0 and walls of 2 cm.</summary>
        public static Mesh Gutter()
        {
            var vertices = new List<Vector3>();
            var triangles = new List<int>();
            AddStrip(vertices, triangles, new Vector3(-0.01f, 0.02f, 0f), new Vector3(-0.01f, 0f, 0f));
            AddStrip(vertices, triangles, new Vector3(-0.01f, 0f, 0f), new Vector3(0.01f, 0f, 0f));
            AddStrip(vertices, triangles, new Vector3(0.01f, 0f, 0f), new Vector3(0.01f, 0.02f, 0f));
            return MeshOf(vertices.ToArray(), triangles.ToArray());
        }

        /// <summary>A step along z without anything below: a floor of 20 cm at y = 0 that ends at x = 0, and a wall down from
        /// there.</summary>
        public static Mesh Step()
        {
            var vertices = new List<Vector3>();
            var triangles = new List<int>();
            AddStrip(vertices, triangles, new Vector3(-0.2f, 0f, 0f), Vector3.zero);
            AddStrip(vertices, triangles, Vector3.zero, new Vector3(0f, -0.1f, 0f));
            return MeshOf(vertices.ToArray(), triangles.ToArray());
        }

        /// <summary>20 cm along z, between two of its edges' middles; its front is on the left of the way.</summary>
        private static void AddStrip(List<Vector3> vertices, List<int> triangles, Vector3 from, Vector3 to)
        {
            var along = new Vector3(0f, 0f, 0.1f);
            int first = vertices.Count;
            vertices.AddRange(new[] { from - along, from + along, to + along, to - along });
            triangles.AddRange(new[] { first, first + 1, first + 2, first, first + 2, first + 3 });
        }

        private static Mesh MeshOf(Vector3[] vertices, int[] triangles) =>
            new Mesh { vertices = vertices, triangles = triangles };
    }
}
