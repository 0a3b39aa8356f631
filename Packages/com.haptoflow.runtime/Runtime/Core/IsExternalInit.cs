namespace System.Runtime.CompilerServices
{
    /// <summary>What the compiler needs for records; Unity's profile, .NET Standard 2.1, does not have it. The
    /// assemblies that see the core's internals use this one.</summary>
    internal static class IsExternalInit
    {
    }
}
