using System;
using System.Diagnostics;
using System.IO;
using System.Linq;
using System.Reflection;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using HaptoFlow.Native;
using NUnit.Framework;

namespace HaptoFlow.WrongLibraryTests
{
    /// <summary>Stands in for the native library.</summary>
    internal static unsafe class StubLibrary
    {
        private static readonly string Folder = Path.Combine(Path.GetTempPath(), $"haptoflow-stub-{Guid.NewGuid():N}");
        private static IntPtr stub;

        /// <summary>Calls of other functions than those of agreement since <see cref="Become"/>.</summary>
        public static int Calls => ((delegate* unmanaged[Cdecl]<int>)Export("stub_calls"))();

        /// <summary>Gives the library a version, and the structs of the C# with one size changed.</summary>
        public static void Become(string version, string changed = "", int bytes = 0)
        {
            fixed (byte* text = NativeCall.Utf8(version))
            {
                ((delegate* unmanaged[Cdecl]<byte*, void>)Export("stub_become"))(text);
            }
            var add = (delegate* unmanaged[Cdecl]<byte*, uint, void>)Export("stub_add_struct");
            foreach (string name in LibraryAgreement.Structs.Keys.Where(name => name != changed || bytes != 0))
            {
                fixed (byte* text = NativeCall.Utf8(name))
                {
                    add(text, (uint)(name == changed ? bytes : LibraryAgreement.Structs[name]));
                }
            }
        }

        public static void Delete() => Directory.Delete(Folder, true);

        private static IntPtr Export(string name) => NativeLibrary.GetExport(stub, name);

        /// <summary>Compiles and loads it, or ignores the tests where there is no C compiler.</summary>
        public static void Build()
        {
            Directory.CreateDirectory(Folder);
            string file = Path.Combine(Folder, "libstub.so");
            try
            {
                using Process compiler = Process.Start(
                    "cc", new[] { "-shared", "-fPIC", "-o", file, Path.Combine(HereFolder(), "stub.c") });
                compiler.WaitForExit();
                Assert.That(compiler.ExitCode, Is.Zero);
            }
            catch (System.ComponentModel.Win32Exception)
            {
                Assert.Ignore("there is no C compiler `cc`");
            }
            stub = NativeLibrary.Load(file);
        }

        private static string HereFolder([CallerFilePath] string path = "") => Path.GetDirectoryName(path)!;

        [ModuleInitializer]
        internal static void Lead() => NativeLibrary.SetDllImportResolver(typeof(HapticModel).Assembly, Resolve);

        private static IntPtr Resolve(string name, Assembly assembly, DllImportSearchPath? searchPath) =>
            name == "audioplugin_haptoflow" ? stub : IntPtr.Zero;
    }
}
