using System;
using System.Linq;
using System.Text;
using UnityShim;

namespace UnityEngine
{
    public struct Mathf
    {
        public const float PI = 3.14159274F;

        public static float Clamp01(float value) => Clamp(value, 0f, 1f);
        public static float Clamp(float value, float min, float max) => value < min ? min : value > max ? max : value;
        public static float Max(float a, float b) => a > b ? a : b;
        public static float Min(float a, float b) => a < b ? a : b;
        public static float Abs(float f) => Math.Abs(f);
        public static float Sqrt(float f) => (float)Math.Sqrt(f);
    }

    public struct LayerMask
    {
        private int mask;

        public int value
        {
            get => mask;
            set => mask = value;
        }

        /// <summary>The name of a layer; empty if it has none.</summary>
        public static string LayerToName(int layer) => UnityShim.ProjectNames.Layers[layer];

        public static implicit operator int(LayerMask mask) => mask.mask;
        public static implicit operator LayerMask(int intVal) => new LayerMask { mask = intVal };
    }

    public struct Ray
    {
        public Ray(Vector3 origin, Vector3 direction)
        {
            this.origin = origin;
            unit = direction.normalized;
        }

        private Vector3 unit;

        public Vector3 origin { get; set; }

        public Vector3 direction
        {
            get => unit;
            set => unit = value.normalized;
        }
    }

    public struct RaycastHit
    {
        public Vector3 point { get; set; }
        public Vector3 normal { get; set; }
        public float distance { get; set; }

        /// <summary>The index of the triangle, for non-convex meshes; -1 for other colliders.</summary>
        public int triangleIndex { get; internal set; }

        /// <summary>The texture coordinates, for readable non-convex meshes that have them; 0 for other colliders.
        /// </summary>
        public Vector2 textureCoord { get; internal set; }

        public Vector2 textureCoord2 { get; internal set; }
    }

    public enum QueryTriggerInteraction
    {
        Ignore = 1,
    }

    public enum RigidbodyInterpolation
    {
        None = 0,
        Interpolate = 1,
    }

    [Flags]
    public enum HideFlags
    {
        None = 0,
        HideInInspector = 2,
        HideAndDontSave = 61,
    }

    public enum FindObjectsInactive
    {
        Exclude = 0,
        Include = 1,
    }

    public enum FindObjectsSortMode
    {
        None = 0,
        InstanceID = 1,
    }

    public enum LogType
    {
        Error = 0,
        Assert = 1,
        Warning = 2,
        Log = 3,
        Exception = 4,
    }

    public static class JsonUtility
    {
        /// <summary>The serialised fields by their names; the shim writes each value as a text.</summary>
        public static string ToJson(object obj) => "{" + string.Join(",", SerializedFields.Leaves(obj)
            .Select(path => $"\"{path}\":\"{SerializedFields.Get(obj, path)}\"")) + "}";
    }

    public class TextAsset : Object
    {
        private readonly string content;
        private readonly byte[]? file;

        public TextAsset()
            : this("")
        {
        }

        public TextAsset(string text) => content = text;

        /// <summary>Creates an asset from bytes, as the importer does for a binary file.</summary>
        internal TextAsset(byte[] file)
            : this("") => this.file = file;

        public string text => content;

        public byte[] bytes => file != null ? (byte[])file.Clone() : Encoding.UTF8.GetBytes(content);
    }

    public class Time
    {
        public static double timeAsDouble => Clock.Seconds;
        public static double unscaledTimeAsDouble => Clock.UnscaledSeconds;
        public static double realtimeSinceStartupAsDouble => Clock.UnscaledSeconds;
        public static float unscaledDeltaTime => (float)Clock.UnscaledDeltaSeconds;
        public static double fixedTimeAsDouble => Clock.FixedSeconds;
        public static double fixedUnscaledTimeAsDouble => Clock.FixedUnscaledSeconds;
        public static float fixedDeltaTime
        {
            get => (float)Clock.FixedStepSeconds;
            set => Clock.FixedStepSeconds = value;
        }

        public static float timeScale
        {
            get => (float)Clock.Scale;
            set => Clock.Scale = value;
        }

        public static int frameCount => Clock.Frames;
        public static bool inFixedTimeStep => Clock.InFixedStep;
    }
}
