using System.Text;

namespace UnityEngine
{
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
}
