#nullable enable
using System.IO;
using System.Text;
using HaptoFlow.Model;
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Makes a <see cref="HapticMaterial"/> that carries its embedding of a .haptomaterial file. A damaged
    /// file becomes a material too, so that surfaces go on referring to it when the file is replaced; what is wrong
    /// stands in the console and in its Inspector.</summary>
    [ScriptedImporter(1, "haptomaterial")]
    public sealed class HapticMaterialImporter : ScriptedImporter
    {
        /// <inheritdoc/>
        public override void OnImportAsset(AssetImportContext ctx)
        {
            // Paths of packages are no paths of the disk.
            string text = ReadText(FileUtil.GetPhysicalPath(ctx.assetPath));
            ctx.DependsOnSourceAsset(ProjectSettingsAsset.DefaultModelPath);
            HapticMaterial material;
            string? problem = null;
            try
            {
                material = HapticMaterial.Create(text, NearestLabel(MaterialFile.Read(text)));
            }
            catch (HaptoFlowException refusal)
            {
                problem = refusal.Message;
                material = ScriptableObject.CreateInstance<HapticMaterial>();
            }
            ctx.AddObjectToAsset("material", material);
            ctx.SetMainObject(material);
            if (problem != null)
            {
                ctx.LogImportError($"HaptoFlow: {ctx.assetPath}: {problem}", material);
            }
        }

        internal static string ReadText(string path) => new UTF8Encoding(false).GetString(File.ReadAllBytes(path));

        /// <summary>Felt where the material cannot be. Only the package's own model is sure to be there while assets
        /// are imported; for any other, the first label of descriptions stays.</summary>
        private static string NearestLabel(MaterialFile material)
        {
            const string unknown = "wood";
            try
            {
                string path = FileUtil.GetPhysicalPath(ProjectSettingsAsset.DefaultModelPath);
                ModelSpace space = ModelSpace.Of(File.ReadAllBytes(path));
                return space.Id == material.Space ? space.NearestLabel(material.Embedding) : unknown;
            }
            catch (System.Exception error) when (error is IOException || error is HaptoFlowException)
            {
                return unknown;
            }
        }
    }
}
