#nullable enable
using System;
using HaptoFlow.Model;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>A .haptoflow model as an asset: the bytes of the file, unchanged.</summary>
    [HelpPage(HelpPages.Components + "haptic-model")]
    public sealed class HapticModelAsset : ScriptableObject
    {
        [SerializeField, HideInInspector]
        private byte[] file = Array.Empty<byte>();

        private ModelHeader? header;

        /// <summary>The bytes of the whole file. Do not modify.</summary>
        public byte[] File => file;

        /// <summary>The header of the file, which the native library reads and verifies once.</summary>
        /// <exception cref="HaptoFlowException">The library is missing, or the bytes are not a usable
        /// model; the message says why.</exception>
        public ModelHeader Header => header ??= ModelHeader.Read(file);

        /// <summary>Creates an asset, for importers and for programs that load models themselves.</summary>
        /// <param name="bytes">The whole .haptoflow file; the array is kept, not copied.</param>
        public static HapticModelAsset Create(byte[] bytes)
        {
            var asset = CreateInstance<HapticModelAsset>();
            asset.file = bytes;
            return asset;
        }
    }
}
