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

        /// <summary>As the importer makes it of a file that holds no text.</summary>
        internal TextAsset(byte[] file)
            : this("") => this.file = file;

        public string text => content;

        public byte[] bytes => file != null ? (byte[])file.Clone() : Encoding.UTF8.GetBytes(content);
    }
}
