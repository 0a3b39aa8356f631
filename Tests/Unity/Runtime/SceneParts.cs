#nullable enable
using System;
using System.Collections;
using System.Collections.Generic;
using System.Linq;
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
            transform.position = Path!(Seconds);
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

    /// <summary>Keeps the lines that are logged during its lifetime.</summary>
    internal sealed class LogRecord : IDisposable
    {
        public LogRecord() => Application.logMessageReceived += Receive;

        public List<(LogType Type, string Text)> Lines { get; } = new List<(LogType Type, string Text)>();

        public void Dispose() => Application.logMessageReceived -= Receive;

        private void Receive(string text, string trace, LogType type) => Lines.Add((type, text));
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

        internal Material Paint(string name)
        {
            GameObject sphere = GameObject.CreatePrimitive(PrimitiveType.Sphere);
            Material paint = Keep(new Material(sphere.GetComponent<MeshRenderer>().sharedMaterial!) { name = name });
            Object.DestroyImmediate(sphere);
            return paint;
        }

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

        internal static float WeightOf(HapticStylus stylus, string label) =>
            Felt(stylus).Where(each => each.Label == label).Sum(each => each.Weight);

        /// <summary>Rests a tip on each place of the board; it feels one material alone there, "" for none.</summary>
        internal IEnumerator Feels(params (float X, string Label)[] places)
        {
            HapticStylus[] styluses = Array.ConvertAll(places, place => Resting(place.X));
            yield return Frames(2);
            Assert.That(Array.ConvertAll(styluses, FeltAlone), Is.EqualTo(places.Select(place => place.Label)));
        }

        /// <summary>Waits for the next frame, and asserts that the tip then feels this label and no blend.</summary>
        internal static IEnumerator FeelsNext(HapticStylus stylus, string label, string why = "")
        {
            yield return null;
            Assert.That(FeltAlone(stylus), Is.EqualTo(label), why);
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
