#nullable enable
using System.IO;
using System.Text;
using HaptoFlow.Model;
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Imports a .haptomaterial file as a <see cref="HapticMaterial"/> that contains its embedding. A damaged
    /// file also becomes a material, so that references to it still hold when the file is replaced; the problem is
    /// shown in the console and in its Inspector. Where the native library is missing, the material keeps the file
    /// unchecked, for players that have the library.</summary>
    [ScriptedImporter(1, "haptomaterial")]
    public sealed class HapticMaterialImporter : ScriptedImporter
    {
        private const string DefaultLabel = "wood";

        /// <inheritdoc/>
        public override void OnImportAsset(AssetImportContext ctx)
        {
            // Asset paths of packages are virtual.
            byte[] file = File.ReadAllBytes(FileUtil.GetPhysicalPath(ctx.assetPath));
            string text = TextOf(file);
            ctx.DependsOnSourceAsset(ProjectSettingsAsset.DefaultModelPath);
            HapticMaterial material;
            FileProblem? problem = null;
            try
            {
                material = HapticMaterial.Create(text, NearestLabel(MaterialFile.Read(text)));
            }
            catch (HaptoFlowException refusal)
            {
                problem = FileProblem.Of(refusal, file);
                material = problem.WasChecked
                    ? ScriptableObject.CreateInstance<HapticMaterial>()
                    : HapticMaterial.CreateUnchecked(
                        text, Path.GetFileNameWithoutExtension(ctx.assetPath), DefaultLabel);
            }
            ctx.AddObjectToAsset("material", material);
            ctx.SetMainObject(material);
            problem?.Log(ctx, material);
        }

        internal static string TextOf(byte[] file) => new UTF8Encoding(false).GetString(file);

        /// <summary>The label that replaces the material where the material cannot be used. During an import, only the
        /// package's own model is sure to exist; for materials of other models, it is the default label.</summary>
        private static string NearestLabel(MaterialFile material)
        {
            try
            {
                string path = FileUtil.GetPhysicalPath(ProjectSettingsAsset.DefaultModelPath);
                using HapticModel model = HapticModel.Open(File.ReadAllBytes(path));
                return model.Space == material.Space ? model.NearestLabel(material.Embedding) : DefaultLabel;
            }
            catch (System.Exception error) when (error is IOException || error is HaptoFlowException)
            {
                return DefaultLabel;
            }
        }
    }
}
