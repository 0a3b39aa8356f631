#nullable enable
using System;
using HaptoFlow.Model;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>A .haptoflow model as an asset: its bytes, as the importer found them.</summary>
    [HelpURL(HelpPages.Components + "haptic-model")]
    public sealed class HapticModelAsset : ScriptableObject
    {
        [SerializeField, HideInInspector]
        private byte[] file = Array.Empty<byte>();

        private ModelHeader? header;

        /// <summary>Bytes of the whole file. Not to be changed.</summary>
        public byte[] File => file;

        /// <summary>What the file says about itself; read once.</summary>
        /// <exception cref="HaptoFlowException">The bytes are no usable model; the message says why.</exception>
        public ModelHeader Header => header ??= ModelHeader.Read(file);

        /// <summary>For importers and programs that load models of their own.</summary>
        /// <param name="bytes">Of a whole .haptoflow file; kept.</param>
        public static HapticModelAsset Create(byte[] bytes)
        {
            var asset = CreateInstance<HapticModelAsset>();
            asset.file = bytes;
            return asset;
        }
    }
}
