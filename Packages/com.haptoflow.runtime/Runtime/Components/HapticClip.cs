#nullable enable
using System;
using System.Text;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>A clip of a designer's tool as an asset: the text of a .haptic, .ahap or .hjif file, unchanged. Played
    /// by <see cref="HapticStylus.Play"/> and <see cref="HapticClipPlayer"/>. Main thread.</summary>
    /// <remarks>The native library reads the text on first use and keeps it until the asset is disabled. A voice that
    /// plays it then plays on.</remarks>
    [HelpPage(HelpPages.Components + "haptic-clip")]
    public sealed class HapticClip : ScriptableObject
    {
        [SerializeField, HideInInspector]
        private byte[] file = Array.Empty<byte>();

        [NonSerialized]
        private HapticClipFile? content;

        [NonSerialized]
        private string? problem;

        [NonSerialized]
        private bool isProblemSaid;

        /// <summary>The bytes of the whole file. Do not modify.</summary>
        public byte[] File => file;

        /// <summary>Why the clip cannot be played: the library is missing, or the text is not a clip. Null for one that
        /// can.</summary>
        public string? Problem => Open() == null ? problem : null;

        /// <summary>Figures of the clip; zeros where there is a <see cref="Problem"/>.</summary>
        public HapticClipInfo Info => Open()?.Info ?? default;

        /// <summary>The clip in the library; null where there is a problem, which the console says once.</summary>
        internal HapticClipFile? Content
        {
            get
            {
                HapticClipFile? opened = Open();
                if (opened == null && !isProblemSaid)
                {
                    isProblemSaid = true;
                    Debug.LogWarning($"HaptoFlow: the clip {name} is not felt: {problem}", this);
                }
                return opened;
            }
        }

        /// <summary>Creates an asset, for importers and for programs that load clips themselves. Text that is no clip is
        /// accepted; <see cref="Problem"/> then says why it is not felt.</summary>
        /// <param name="bytes">The whole file in UTF-8; the array is kept, not copied.</param>
        public static HapticClip Create(byte[] bytes)
        {
            var clip = CreateInstance<HapticClip>();
            clip.file = bytes;
            return clip;
        }

        /// <summary>As <see cref="Create"/>, of the text of a file. Destroy the clip when it is no longer
        /// needed.</summary>
        public static HapticClip FromText(string text) => Create(new UTF8Encoding(false).GetBytes(text));

        /// <summary>As <see cref="Create"/>, of a file that Unity imported as text: one whose name ends in .json,
        /// .txt or .bytes.</summary>
        public static HapticClip FromText(TextAsset text)
        {
            HapticClip clip = Create(text.bytes);
            clip.name = text.name;
            return clip;
        }

        private HapticClipFile? Open()
        {
            if (content == null && problem == null)
            {
                try
                {
                    content = HapticClipFile.Read(file);
                }
                catch (HaptoFlowException refusal)
                {
                    problem = refusal.Message;
                }
            }
            return content;
        }

        private void OnDisable()
        {
            content?.Dispose();
            content = null;
            problem = null;
            isProblemSaid = false;
        }
    }
}
