using System;
using System.Collections.Generic;
using UnityEngine;
using UnityShim;

namespace UnityEngine
{
    public enum TextureFormat
    {
        RGBA32 = 4,
        RGBAFloat = 20,
    }

    public enum TextureWrapMode
    {
        Repeat = 0,
        Clamp = 1,
    }

    public partial class Texture
    {
        public virtual int width { get; set; }
        public virtual int height { get; set; }
        public TextureWrapMode wrapMode { get; set; }
        public virtual bool isReadable => true;
        public Hash128 imageContentsHash { get; set; }
    }

    public partial struct Hash128
    {
        private readonly ulong low;

        public Hash128(ulong u64_0, ulong u64_1) => low = u64_0 ^ (31UL * u64_1);

        public override string ToString() => low.ToString("x32");
    }

    public partial struct Color32
    {
        public byte r;
        public byte g;
        public byte b;
        public byte a;

        public Color32(byte r, byte g, byte b, byte a) => (this.r, this.g, this.b, this.a) = (r, g, b, a);

        public static implicit operator Color32(Color c) => new Color32(
            Byte(255f * c.r), Byte(255f * c.g), Byte(255f * c.b), Byte(255f * c.a));

        public static Color32 Lerp(Color32 a, Color32 b, float t) => new Color32(
            Byte(a.r + Mathf.Clamp01(t) * (b.r - a.r)), Byte(a.g + Mathf.Clamp01(t) * (b.g - a.g)),
            Byte(a.b + Mathf.Clamp01(t) * (b.b - a.b)), Byte(a.a + Mathf.Clamp01(t) * (b.a - a.a)));

        private static byte Byte(float value) => (byte)Math.Round(Mathf.Clamp(value, 0f, 255f));
    }

    public sealed partial class Texture2D : Texture
    {
        /// <summary>Unity's own: never destroyed.</summary>
        public static Texture2D whiteTexture { get; } = new Texture2D("UnityWhite");

        private readonly int bytes;

        public Texture2D(int width, int height, TextureFormat textureFormat, bool mipChain)
        {
            World.RequireMainThread();
            this.width = width;
            this.height = height;
            bytes = 4 * width * height;
            MediaCount.Add(this);
        }

        public Texture2D(int width, int height, TextureFormat textureFormat, bool mipChain, bool linear)
            : this(width, height, textureFormat, mipChain)
        {
        }

        private Texture2D(string name) => this.name = name;

        // As the graphics card has them, whether or not scripts may read them.
        internal Color[] Pixels = Array.Empty<Color>();
        private bool isKept = true;

        public override bool isReadable => isKept;

        /// <exception cref="UnityException">The texture is not readable.</exception>
        public Color32[] GetPixels32() => isKept
            ? Array.ConvertAll(Pixels, pixel => (Color32)pixel)
            : throw new UnityException($"Texture '{name}' is not readable.");

        public void SetPixels32(Color32[] colors)
        {
            Pixels = Array.ConvertAll(colors, each =>
                new Color(each.r / 255f, each.g / 255f, each.b / 255f, each.a / 255f));
            ulong sum = 17;
            foreach (Color32 each in colors)
            {
                sum = 31 * sum + (uint)(each.r << 24 | each.g << 16 | each.b << 8 | each.a);
            }
            imageContentsHash = new Hash128(sum, 0);
        }

        public Color[] GetPixels() => isKept
            ? (Color[])Pixels.Clone()
            : throw new UnityException($"Texture '{name}' is not readable.");

        public void SetPixels(Color[] colors) => Pixels = (Color[])colors.Clone();

        /// <summary>Copies the whole of the active render texture.</summary>
        public void ReadPixels(Rect source, int destX, int destY, bool recalculateMipMaps) =>
            SetPixels(RenderTexture.active!.Pixels);

        public void Apply(bool updateMipmaps, bool makeNoLongerReadable)
        {
            Apply(updateMipmaps);
            isKept = !makeNoLongerReadable;
        }

        public void LoadRawTextureData(byte[] data)
        {
            World.RequireMainThread();
            if (data.Length < bytes)
            {
                throw new UnityException($"LoadRawTextureData: not enough data provided: {data.Length} of {bytes}");
            }
        }

        public void Apply(bool updateMipmaps) => World.RequireMainThread();
    }

    public enum RenderTextureFormat
    {
        ARGBFloat = 11,
    }

    public enum RenderTextureReadWrite
    {
        Linear = 1,
    }

    public partial class RenderTexture : Texture
    {
        internal Color[] Pixels = Array.Empty<Color>();

        private RenderTexture()
        {
        }

        public static RenderTexture? active { get; set; }

        public static RenderTexture GetTemporary(int width, int height, int depthBuffer, RenderTextureFormat format,
            RenderTextureReadWrite readWrite)
        {
            var made = new RenderTexture { width = width, height = height };
            MediaCount.Add(made);
            return made;
        }

        /// <summary>Returns it to a pool in Unity; destroys it here.</summary>
        public static void ReleaseTemporary(RenderTexture temp) => DestroyImmediate(temp);
    }

    public sealed partial class Graphics
    {
        /// <summary>Copies a texture of the same size.</summary>
        public static void Blit(Texture source, RenderTexture dest) =>
            dest.Pixels = (Color[])((Texture2D)source).Pixels.Clone();
    }

    public sealed partial class AudioClip : Object
    {
        private float[] content = Array.Empty<float>();

        private AudioClip()
        {
        }

        public int samples => content.Length / channels;
        public int channels { get; private set; }
        public int frequency { get; private set; }

        public static AudioClip Create(string name, int lengthSamples, int channels, int frequency, bool stream)
        {
            World.RequireMainThread();
            var clip = new AudioClip { name = name, channels = channels, frequency = frequency };
            clip.content = new float[lengthSamples * channels];
            MediaCount.Add(clip);
            return clip;
        }

        public bool SetData(float[] data, int offsetSamples)
        {
            data.CopyTo(content, offsetSamples * channels);
            return true;
        }

        public bool GetData(float[] data, int offsetSamples)
        {
            Array.Copy(content, offsetSamples * channels, data, 0, data.Length);
            return true;
        }
    }

    public partial class UnityException : SystemException
    {
        public UnityException(string message)
            : base(message)
        {
        }
    }

    public sealed partial class Gizmos
    {
        internal static readonly List<(Vector3 From, Vector3 To, Color Color)> Lines =
            new List<(Vector3 From, Vector3 To, Color Color)>();

        internal static readonly List<(Vector3 Position, Quaternion Rotation, Vector3 Size, Color Color)> Solids =
            new List<(Vector3 Position, Quaternion Rotation, Vector3 Size, Color Color)>();

        public static Color color { get; set; } = Color.white;
        public static Matrix4x4 matrix { get; set; }

        public static void DrawCube(Vector3 center, Vector3 size) =>
            Solids.Add((matrix.Position, matrix.Rotation, matrix.Scale, color));

        public static void DrawSphere(Vector3 center, float radius) => DrawCube(center, 2f * radius * Vector3.one);

        public static void DrawLine(Vector3 from, Vector3 to) => Lines.Add((from, to, color));

        public static void DrawWireSphere(Vector3 center, float radius)
        {
        }
    }
}

namespace UnityEditor
{
    internal partial class AudioUtil
    {
        public static void PlayPreviewClip(UnityEngine.AudioClip clip, int startSample = 0, bool loop = false) =>
            ClipPreview.Begin(clip, startSample, loop);

        public static bool IsPreviewClipPlaying() => ClipPreview.Playing != null;

        public static void StopAllPreviewClips() => ClipPreview.End();

        public static int GetPreviewClipSamplePosition() => ClipPreview.Position;
    }

    [Flags]
    public enum GizmoType
    {
        Selected = 4,
        Active = 8,
        NonSelected = 32,
    }

    public sealed partial class DrawGizmo : Attribute
    {
        public DrawGizmo(GizmoType gizmo)
        {
        }
    }

    public partial class SearchableEditorWindow : EditorWindow
    {
    }

    public partial class SceneView : SearchableEditorWindow
    {
    }

    public sealed partial class Handles
    {
        internal static readonly List<string> Labels = new List<string>();

        public static Color color { get; set; } = Color.white;

        public static void DrawAAPolyLine(Texture2D? lineTex, float width, params Vector3[] points) =>
            ScreenPaint.Add(nameof(DrawAAPolyLine), Around(points), color);

        public static void DrawLines(Vector3[] lineSegments) =>
            ScreenPaint.Add(nameof(DrawLines), Around(lineSegments), color);

        private static Rect Around(Vector3[] points)
        {
            Vector3 low = points[0];
            Vector3 high = points[0];
            foreach (Vector3 point in points)
            {
                low = new Vector3(Mathf.Min(low.x, point.x), Mathf.Min(low.y, point.y), 0f);
                high = new Vector3(Mathf.Max(high.x, point.x), Mathf.Max(high.y, point.y), 0f);
            }
            return new Rect(low.x, low.y, high.x - low.x, high.y - low.y);
        }

        public static void Label(Vector3 position, string text) => Labels.Add(text);
    }
}

namespace UnityShim
{
    /// <summary>Counts textures and clips, which stay in Unity's memory until they are destroyed.</summary>
    public static class MediaCount
    {
        private static readonly List<UnityEngine.Object> Made = new List<UnityEngine.Object>();

        /// <summary>The objects that were created and not destroyed.</summary>
        public static int Alive => Made.FindAll(each => each != null).Count;

        internal static void Add(UnityEngine.Object made) => Made.Add(made);
    }

    /// <summary>The clip that the editor plays outside a scene.</summary>
    public static class ClipPreview
    {
        private static bool loops;

        /// <summary>The clip; null for silence.</summary>
        public static UnityEngine.AudioClip? Playing { get; private set; }

        /// <summary>The sample that is played next.</summary>
        public static int Position { get; private set; }

        /// <summary>Lets time pass.</summary>
        public static void Advance(int samples)
        {
            Position += samples;
            if (Playing != null && Position >= Playing.samples)
            {
                Position = loops ? Position % Playing.samples : 0;
                Playing = loops ? Playing : null;
            }
        }

        internal static void Begin(UnityEngine.AudioClip clip, int start, bool loop)
        {
            Playing = clip;
            Position = start;
            loops = loop;
        }

        internal static void End() => Playing = null;
    }
}
