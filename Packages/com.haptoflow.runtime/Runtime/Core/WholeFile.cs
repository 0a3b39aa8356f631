#nullable enable
using System.IO;
using System.Text;

namespace HaptoFlow.Files
{
    /// <summary>Writes a text file atomically: a reader sees the old text or the new one, also after a crash. Any
    /// thread that may access files.</summary>
    internal static class WholeFile
    {
        /// <summary>Writes UTF-8 without byte order mark and creates the folder; the text is on disk when the call
        /// returns.</summary>
        /// <exception cref="IOException">The file cannot be written.</exception>
        /// <exception cref="System.UnauthorizedAccessException">The file cannot be written.</exception>
        public static void Write(string path, string text)
        {
            Directory.CreateDirectory(Path.GetDirectoryName(Path.GetFullPath(path))!);
            string temporary = path + ".new";
            using (var stream = new FileStream(temporary, FileMode.Create, FileAccess.Write))
            {
                byte[] bytes = new UTF8Encoding(false).GetBytes(text);
                stream.Write(bytes, 0, bytes.Length);
                stream.Flush(true);
            }
            if (File.Exists(path))
            {
                File.Replace(temporary, path, null);
            }
            else
            {
                File.Move(temporary, path);
            }
        }
    }
}
