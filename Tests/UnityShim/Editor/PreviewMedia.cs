using System;
using System.Collections.Generic;
using UnityShim;

namespace UnityEngine
{
    public enum TextureFormat
    {
        RGBA32 = 4,
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
    }

    public sealed partial class Texture2D : Texture
    {
        private readonly int bytes;
        private byte[] waiting = Array.Empty<byte>();

        public Texture2D(int width, int height, TextureFormat textureFormat, bool mipChain)
        {
            World.RequireMainThread();
            this.width = width;
            this.height = height;
            bytes = 4 * width * height;
            MediaCount.Add(this);
        }

        /// <summary>What the graphics card has.</summary>
        internal byte[] Uploaded { get; private set; } = Array.Empty<byte>();

        public void LoadRawTextureData(byte[] data)
        {
            World.RequireMainThread();
            if (data.Length < bytes)
            {
                throw new UnityException($"LoadRawTextureData: not enough data provided: {data.Length} of {bytes}");
            }
            waiting = data;
        }

        public void Apply(bool updateMipmaps)
        {
            World.RequireMainThread();
            Uploaded = waiting;
        }
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
}

namespace UnityShim
{
    /// <summary>Textures and clips, which Unity keeps until somebody destroys them.</summary>
    public static class MediaCount
    {
        private static readonly List<UnityEngine.Object> Made = new List<UnityEngine.Object>();

        /// <summary>Made and not destroyed.</summary>
        public static int Alive => Made.FindAll(each => each != null).Count;

        internal static void Add(UnityEngine.Object made) => Made.Add(made);
    }

    /// <summary>The one clip that the editor plays by itself.</summary>
    public static class ClipPreview
    {
        private static bool loops;

        /// <summary>Null for silence.</summary>
        public static UnityEngine.AudioClip? Playing { get; private set; }

        /// <summary>The sample that sounds next.</summary>
        public static int Position { get; private set; }

        /// <summary>Time passes.</summary>
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
