#nullable enable
using UnityEngine;

namespace HaptoFlow.Tests
{
    /// <summary>Takes the worker's place, one round after every frame, so that a test hears the same on every machine.
    /// </summary>
    [DefaultExecutionOrder(2000)]
    internal sealed class EngineStepper : MonoBehaviour
    {
        private void LateUpdate() => HapticSession.Existing?.Engine?.Step();
    }
}
