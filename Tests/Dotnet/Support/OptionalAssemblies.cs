using System.Reflection;

namespace HaptoFlow.Tests.Support
{
    internal static class OptionalAssemblies
    {
        /// <summary>Loads them: .NET loads an assembly on first use only, unlike Unity, so that they would not register.
        /// </summary>
        public static void Load()
        {
            foreach (string name in new[]
                { "Meta", "InputSystem", "Inputs.OpenXr" })
            {
                Assembly.Load("HaptoFlow." + name);
            }
        }
    }
}
