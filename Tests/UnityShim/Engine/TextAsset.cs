using System.Text;

namespace UnityEngine
{
    public class TextAsset : Object
    {
        private readonly string content;

        public TextAsset()
            : this("")
        {
        }

        public TextAsset(string text) => content = text;

        public string text => content;

        public byte[] bytes => Encoding.UTF8.GetBytes(content);
    }
}
